// One of the stacked charts: title and legend above its plot, the range of its y axis, and the values under
// the cursor.
#pragma once

#include <QWidget>

#include "charts/chart_buttons.h"
#include "charts/plot_view.h"

class QLabel;

namespace clothlab {

class LiveChart : public QWidget {
  Q_OBJECT
 public:
  LiveChart(const ChartSpec& spec, bool time_labels, QWidget* parent = nullptr);

  const ChartSpec& spec() const { return spec_; }
  PlotScene& scene() { return *scene_; }
  PlotView& view() { return *view_; }

  bool is_logarithmic() const { return logarithmic_; }
  void set_logarithmic(bool on);
  /// Whether the user has chosen the y range.
  bool has_own_y_range() const { return own_y_.has_value(); }
  void zoom_y(double anchor, double factor);
  void pan_y(double by) { set_y_range(Range{frame_.y.low + by, frame_.y.high + by}); }
  void set_y_range(std::optional<Range> axis_range);

  /// First half of an update: chooses the range and the ticks for these times. Returns the room its y labels
  /// need (px).
  double prepare(const ChartRecord& record, Range time);
  /// Second half: draws with the plot's left edge at `gutter`.
  void draw(const ChartRecord& record, double gutter);
  /// Shows the values at the sample nearest to a time, or nothing.
  void read(const ChartRecord& record, std::optional<double> time_s);
  void set_message(const QString& message) { scene_->overlay().set_message(message); }
  void apply_look();
  /// Whether the legend has room for the curves' names beside the title.
  bool has_room_for_names(int width) const;
  /// Shows the curves' names in the legend, or their short names.
  void name_curves(bool in_full);
  /// A low chart gives the title of its time axis to the plot, and the rows of its legend where the curves'
  /// names stand elsewhere.
  void set_low(bool low) { is_low_ = low; }
  void show_curve(std::size_t curve, bool shown) { legend_[curve]->setChecked(shown); }

  void lay_out();
  /// Rows of the header at a width, and the whole height that is not plot (px).
  int height_beside_plot(int width) const;
  /// What is drawn now, for an exported picture.
  PlotFrame frame_for(QSizeF plot_size) const;
  bool limit_on(const ChartRecord& record) const;
  std::vector<bool> shown_curves() const;

 Q_SIGNALS:
  void changed();  ///< a curve was hidden or shown, or the scale switched

 protected:
  void resizeEvent(QResizeEvent*) override { lay_out(); }

 private:
  std::vector<LegendEntry*> entries() const;
  /// The legend beside the title where there is room, else in as many rows below it as it takes.
  std::vector<std::vector<LegendEntry*>> legend_rows(int width) const;
  bool legend_beside_title(int width) const;
  int header_height(int width) const;
  Range automatic_y(const ChartRecord& record);
  template <class Include>
  void include_measured(const ChartRecord& record, bool positive, const Include& include) const;
  Range data_range(const ChartRecord& record, bool positive) const;
  void choose_ticks(PlotFrame& frame, QSizeF plot_size) const;
  double height_below_plot() const;
  QRectF plot_rect(double gutter) const;

  const ChartSpec& spec_;
  bool time_labels_;
  QLabel* title_;
  std::vector<LegendEntry*> legend_;
  LegendEntry* limit_entry_ = nullptr;
  FlatButton* log_button_;
  PlotScene* scene_;
  PlotView* view_;
  bool logarithmic_ = false, named_elsewhere_ = false, is_low_ = false;
  std::optional<Range> own_y_;  ///< in axis coordinates
  StickyRange sticky_;
  PlotFrame frame_;
};

}  // namespace clothlab
