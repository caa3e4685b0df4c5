#include "charts/chart_export.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QImage>
#include <QPainter>
#include <QSvgGenerator>
#include <charconv>
#include <cmath>

#include "charts/live_chart.h"
#include "document/result_files.h"

namespace clothlab {

namespace {

constexpr double screen_width_px = 1000;  // the width at which text has the size it has on the screen

QString tr(const char* text) {
  return QCoreApplication::translate("ChartExport", text);
}

QString could_not_write(const QString& path, const QString& why) {
  return tr("Could not write %1: %2.").arg(path, why);
}

QString written(const QString& path, const QByteArray& bytes) {
  const QString problem = write_file(path, bytes);
  return problem.isEmpty() ? problem : could_not_write(path, problem);
}

void paint_header(QPainter& painter, LiveChart& chart, const ChartRecord& record, const QRectF& row,
                  const QFont& font) {
  const Theme& colours = theme();
  QFont bold = font;
  bold.setWeight(QFont::DemiBold);
  painter.setFont(bold);
  painter.setPen(colours.text);
  painter.drawText(row.adjusted(spacing, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, chart.spec().title);
  painter.setFont(font);
  std::vector<const CurveSpec*> entries;
  const std::vector<bool> shown = chart.shown_curves();
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (shown[i]) entries.push_back(&chart.spec().curves[i]);
  if (chart.limit_on(record)) entries.push_back(&limit_spec());
  double right = row.right() - plot_right_margin + spacing / 2.0;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    const int width = LegendEntry::width_of((*entry)->name, font);
    right -= width;
    LegendEntry::paint(painter, QRectF(right, row.top(), width, row.height()).toRect(), (*entry)->name,
                       (*entry)->style, true, colours);
  }
}

void paint_charts(QPainter& painter, QSizeF size, const ChartPicture& picture) {
  const QFont font = chart_font(picture.font);
  const double header = QFontMetricsF(font).height() + spacing;
  const double axis = time_axis_height(font);
  const double overhang = label_overhang(font);
  const auto count = static_cast<double>(picture.charts.size());
  const double plot_height = std::max(
      20.0,
      (size.height() - 2 * spacing - axis - count * (header + overhang) - (count - 1) * overhang) / count);

  double gutter = 0;
  std::vector<PlotFrame> frames;
  for (LiveChart* chart : picture.charts) {
    frames.push_back(chart->frame_for({size.width() - 60, plot_height}));
    gutter = std::max(gutter, label_width(frames.back().y_ticks, font));
  }
  painter.fillRect(QRectF(QPointF(), size), theme().panel);
  double y = spacing;
  for (std::size_t i = 0; i < picture.charts.size(); ++i) {
    const bool lowest = i + 1 == picture.charts.size();
    LiveChart& chart = *picture.charts[i];
    paint_header(painter, chart, picture.record, {0, y, size.width(), header}, font);
    y += header;
    PlotScene scene(chart.spec(), lowest, false);
    scene.set_look(theme(), font);
    const QSizeF part(size.width(), overhang + plot_height + (lowest ? axis : overhang));
    scene.set_geometry(
        part, {gutter + spacing, overhang, part.width() - gutter - spacing - plot_right_margin, plot_height});
    scene.show(picture.record, frames[i]);
    scene.render(&painter, QRectF(QPointF(0, y), part), QRectF(QPointF(), part), Qt::IgnoreAspectRatio);
    y += part.height();
  }
}

/// Lays the charts out in screen px and scales them to the picture.
void paint_picture(QPainter& painter, QSizeF size, const ChartPicture& picture) {
  const double scale = std::max(1.0, size.width() / screen_width_px);
  painter.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing);
  painter.scale(scale, scale);
  paint_charts(painter, size / scale, picture);
}

void append_number(QByteArray& line, double value) {
  if (!std::isfinite(value)) return;
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17);
  line.append(digits, end.ptr - digits);
}

void append_row(QByteArray& csv, const ChartRecord& record, const std::vector<CsvColumn>& columns,
                double time_s, std::optional<std::size_t> sample, std::optional<std::size_t> draw) {
  append_number(csv, time_s);
  for (const CsvColumn& column : columns) {
    csv += ',';
    const bool of_samples = column.source == Source::samples;
    const SampleSeries& series = of_samples ? record.samples : record.draws;
    if (const auto row = of_samples ? sample : draw) append_number(csv, series.value(column.column, *row));
  }
  csv += '\n';
}

}  // namespace

QString save_png(const QString& path, QSize size, const ChartPicture& picture) {
  QImage image(size, QImage::Format_ARGB32_Premultiplied);
  if (size.isEmpty() || image.isNull())
    return could_not_write(path, tr("no picture of this size can be made"));
  {
    QPainter painter(&image);
    paint_picture(painter, size, picture);
  }
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  if (!image.save(&buffer, "PNG")) return could_not_write(path, tr("the picture could not be encoded"));
  return written(path, bytes);
}

QString save_svg(const QString& path, QSize size, const ChartPicture& picture) {
  if (size.isEmpty()) return could_not_write(path, tr("no picture of this size can be made"));
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  {
    QSvgGenerator svg;
    svg.setOutputDevice(&buffer);
    svg.setSize(size);
    svg.setViewBox(QRect(QPoint(), size));
    svg.setResolution(96);
    svg.setTitle(tr("Clothlab charts"));
    QPainter painter(&svg);
    paint_picture(painter, size, picture);
  }
  return written(path, bytes);
}

std::vector<CsvColumn> run_columns() {
  return {{"kinetic_J", Source::samples, kinetic},
          {"elastic_J", Source::samples, elastic},
          {"gravity_J", Source::samples, gravity},
          {"total_J", Source::samples, total},
          {"max_strain", Source::samples, strain},
          {"step_ms", Source::samples, step_time},
          {"draw_ms", Source::draws, 0}};
}

QString save_csv(const QString& path, const ChartRecord& record, const std::vector<CsvColumn>& columns,
                 Range time, const std::stop_token& stop) {
  QByteArray csv("time_s");
  for (const CsvColumn& column : columns) csv += ',' + column.name;
  csv += '\n';
  const SampleSeries& samples = record.samples;
  const SampleSeries& draws = record.draws;
  std::size_t s = samples.lower_bound(time.low), d = draws.lower_bound(time.low);
  const std::size_t s_end = samples.upper_bound(time.high), d_end = draws.upper_bound(time.high);
  while (s < s_end || d < d_end) {
    if (stop.stop_requested()) return tr("It was stopped.");
    const bool sample_first = d == d_end || (s < s_end && samples.time(s) <= draws.time(d));
    const bool draw_first = s == s_end || (d < d_end && draws.time(d) <= samples.time(s));
    const double t = sample_first ? samples.time(s) : draws.time(d);
    append_row(csv, record, columns, t, sample_first ? std::optional(s++) : std::nullopt,
               draw_first ? std::optional(d++) : std::nullopt);
  }
  return written(path, csv);
}

}  // namespace clothlab
