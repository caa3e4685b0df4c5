// The tool bar above the charts: the time span shown, and tools. Buttons without room are in a menu at its
// end.
#pragma once

#include <QWidget>
#include <vector>

#include "charts/time_view.h"

class QMenu;

namespace clothlab {

class FlatButton;

class ChartBar : public QWidget {
  Q_OBJECT
 public:
  explicit ChartBar(QWidget* parent = nullptr);

  void set_span(TimeView::Span span);
  /// Whether the charts follow the run; the button that returns to it is then not needed.
  void set_live(bool live);
  void apply_look(const QFont& font);

  QSize sizeHint() const override;
  /// The time span buttons and the live button are always visible; the others may be in the menu.
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void span_chosen(clothlab::TimeView::Span span);
  void live_wanted();
  void box_mode_changed(bool on);
  void save_wanted();

 protected:
  void resizeEvent(QResizeEvent*) override { lay_out(); }

 private:
  FlatButton* add_button(const QString& text, const char* name, const QString& tip);
  void add_spans();
  void add_tools();
  void lay_out();
  void fill_menu();
  void show_help();

  FlatButton *last_minute_, *whole_run_, *live_;
  std::vector<FlatButton*> tools_;  ///< from left to right; the last is the first to go into the menu
  FlatButton *help_, *more_;
  QMenu* menu_;
};

}  // namespace clothlab
