// The charts as files. Each function returns an empty string, or a sentence that says what went wrong; after
// an error no partial file remains, and an existing file is unchanged.
#pragma once

#include <QByteArray>
#include <QFont>
#include <QSize>
#include <QString>
#include <stop_token>
#include <vector>

#include "charts/chart_record.h"

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

/// One quantity of the record as a column of a file.
struct CsvColumn {
  QByteArray name;  ///< with its unit
  Source source = Source::samples;
  std::size_t column = 0;
};

/// kinetic_J, elastic_J, gravity_J, total_J, max_strain (a fraction), step_ms, draw_ms.
std::vector<CsvColumn> run_columns();

/// RFC 4180, lines ended by LF as in record.csv, one header row: time_s and the columns. Every recorded point
/// of `time` with 17 significant digits and a decimal point whatever the locale; an empty field is a quantity
/// that this point does not have. A drawing that falls on no sample's time has a row of its own. Stopped, it
/// writes nothing.
QString save_csv(const QString& path, const ChartRecord& record, const std::vector<CsvColumn>& columns,
                 Range time, const std::stop_token& stop = {});

}  // namespace clothlab
