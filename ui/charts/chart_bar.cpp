#include "charts/chart_bar.h"

#include <QButtonGroup>
#include <QMenu>
#include <QToolTip>
#include <algorithm>

#include "charts/chart_buttons.h"
#include "charts/plot_view.h"
#include "widgets/building.h"

namespace clothlab {

namespace {

constexpr int gap = spacing / 4;

/// Of buttons in a row, with a gap before each.
int width_of(const std::vector<FlatButton*>& buttons) {
  int width = 0;
  for (const FlatButton* button : buttons) width += gap + button->sizeHint().width();
  return width;
}

}  // namespace

ChartBar::ChartBar(QWidget* parent) : QWidget(parent) {
  add_spans();
  live_ = add_button(tr("● Live"), "live", tr("Follow the run again (double-click or Home)"));
  live_->setAccessibleName(tr("Live"));
  live_->setEmphasised(true);
  live_->hide();
  connect(live_, &FlatButton::clicked, this, &ChartBar::live_wanted);
  add_tools();
  more_ = add_button(QStringLiteral("⋯"), "chart_more", tr("More"));
  more_->setAccessibleName(tr("More"));
  menu_ = named("chart_menu", new QMenu(more_));
  menu_->setToolTipsVisible(true);
  connect(menu_, &QMenu::aboutToShow, this, &ChartBar::fill_menu);
  connect(more_, &FlatButton::clicked, this,
          [this] { menu_->popup(more_->mapToGlobal(QPoint(0, more_->height()))); });
}

FlatButton* ChartBar::add_button(const QString& text, const char* name, const QString& tip) {
  auto* button = named(QString::fromLatin1(name), new FlatButton(text, this));
  button->setToolTip(tip);
  return button;
}

void ChartBar::add_spans() {
  last_minute_ =
      add_button(tr("Last 60 s"), "last_minute", tr("Follow the last 60 seconds of simulated time"));
  whole_run_ = add_button(tr("Whole run"), "whole_run", tr("Show the run from its start"));
  auto* spans = new QButtonGroup(this);
  for (FlatButton* span : {last_minute_, whole_run_}) {
    span->setCheckable(true);
    spans->addButton(span);
  }
  last_minute_->setChecked(true);
  connect(last_minute_, &FlatButton::clicked, this,
          [this] { Q_EMIT span_chosen(TimeView::Span::last_minute); });
  connect(whole_run_, &FlatButton::clicked, this, [this] { Q_EMIT span_chosen(TimeView::Span::whole_run); });
}

void ChartBar::add_tools() {
  FlatButton* box =
      add_button(tr("Zoom box"), "zoom_box", tr("Drag a box to zoom into (or right-drag, or Shift + drag)"));
  box->setCheckable(true);
  connect(box, &FlatButton::toggled, this, &ChartBar::box_mode_changed);
  FlatButton* save =
      add_button(tr("Save…"), "save_charts", tr("Save the charts as PNG or SVG, or their points as CSV"));
  connect(save, &FlatButton::clicked, this, &ChartBar::save_wanted);
  help_ = add_button(tr("?"), "chart_help", PlotView::help());
  help_->setAccessibleName(tr("How to zoom and pan"));
  connect(help_, &FlatButton::clicked, this, &ChartBar::show_help);
  tools_ = {box, save, help_};
}

void ChartBar::show_help() {
  FlatButton* below = help_->isHidden() ? more_ : help_;
  QToolTip::showText(below->mapToGlobal(QPoint(0, below->height())), PlotView::help(), below);
}

/// A click on an entry is a click on its button.
void ChartBar::fill_menu() {
  menu_->clear();
  for (FlatButton* tool : tools_) {
    if (!tool->isHidden()) continue;
    QAction* entry = menu_->addAction(tool->accessibleName(), tool, &FlatButton::click);
    entry->setObjectName("menu:" + tool->objectName());
    entry->setCheckable(tool->isCheckable());
    entry->setChecked(tool->isChecked());
    if (tool != help_) entry->setToolTip(tool->toolTip());
  }
}

void ChartBar::set_span(TimeView::Span span) {
  (span == TimeView::Span::last_minute ? last_minute_ : whole_run_)->setChecked(true);
}

void ChartBar::set_live(bool live) {
  live_->setVisible(!live);
  lay_out();
}

void ChartBar::apply_look(const QFont& font) {
  for (FlatButton* button : findChildren<FlatButton*>()) button->setFont(font);
  updateGeometry();
  lay_out();
}

QSize ChartBar::sizeHint() const {
  return {2 * spacing + width_of({last_minute_, whole_run_, live_}) + width_of(tools_),
          last_minute_->sizeHint().height()};
}

QSize ChartBar::minimumSizeHint() const {
  return {2 * spacing + width_of({last_minute_, whole_run_, live_, more_}), sizeHint().height()};
}

void ChartBar::lay_out() {
  const auto place = [](FlatButton* button, int x) {
    button->setGeometry(QRect({x, 0}, button->sizeHint()));
  };
  place(last_minute_, spacing);
  place(whole_run_, last_minute_->geometry().right() + 1 + gap);
  const int room = width() - spacing - whole_run_->geometry().right() - 1;

  std::vector<FlatButton*> right;
  if (!live_->isHidden()) right.push_back(live_);
  right.insert(right.end(), tools_.begin(), tools_.end());
  const std::size_t fixed = right.size() - tools_.size();
  const bool folded = width_of(right) > room;
  if (folded) {
    right.push_back(more_);
    while (right.size() > fixed + 1 && width_of(right) > room) right.erase(right.end() - 2);
  }
  more_->setVisible(folded);
  for (FlatButton* tool : tools_)
    tool->setVisible(std::find(right.begin(), right.end(), tool) != right.end());
  int x = width() - spacing - width_of(right);
  for (FlatButton* button : right) {
    place(button, x + gap);
    x += gap + button->sizeHint().width();
  }
}

}  // namespace clothlab
