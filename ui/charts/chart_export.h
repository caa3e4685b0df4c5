// The charts as files. Each function returns an empty string, or a sentence that says what went wrong; a file
// that could not be written whole is not left behind, and one that was there before stays as it was.
#pragma once

#include <QFont>
#include <QSize>
#include <QString>
#include <vector>

#include "charts/chart_record.h"

class QPainter;

namespace clothlab {

class LiveChart;

/// The charts to draw, from top to bottom, with what they show now.
struct ChartPicture {
  const ChartRecord& record;
  std::vector<LiveChart*> charts;
  QFont font;
};

/// `size` in logical px. Text and lines grow with the picture: 1000 px of width are drawn as on the screen.
QString save_png(const QString& path, QSize size, const ChartPicture& picture);
QString save_svg(const QString& path, QSize size, const ChartPicture& picture);

/// RFC 4180, lines ended by LF as in record.csv, one header row: time_s, kinetic_J, ... , draw_ms. Every
/// recorded point of `time` with 17 significant digits and a decimal point whatever the locale; an empty
/// field is a quantity that this point does not have. The strain is a fraction. A drawing that falls on no
/// sample's time has a row of its own.
QString save_csv(const QString& path, const ChartRecord& record, Range time);

}  // namespace clothlab
