#include "widgets/notice_bar.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

NoticeBar::NoticeBar(QWidget* parent)
    : QFrame(parent),
      symbol_(new QLabel(this)),
      label_(new QLabel(this)),
      button_(new QPushButton(this)),
      close_(new QToolButton(this)) {
  setObjectName("noticeBar");
  label_->setObjectName("noticeText");
  label_->setWordWrap(true);
  label_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  button_->setObjectName("noticeButton");
  close_->setObjectName("noticeClose");
  close_->setIcon(icon("remove"));
  close_->setAutoRaise(true);
  close_->setToolTip(tr("Close this message"));
  close_->setAccessibleName(tr("Close this message"));

  auto* row =
      spaced(new QHBoxLayout(this), spacing, {spacing + spacing / 2, spacing / 2, spacing / 2, spacing / 2});
  row->addWidget(symbol_);
  row->addWidget(label_, 1);
  row->addWidget(button_);
  row->addWidget(close_);
  connect(close_, &QToolButton::clicked, this, &QWidget::hide);
  connect(button_, &QPushButton::clicked, this, [this] {
    const auto action = action_;
    hide();
    if (action) action();
  });
  hide();
}

void NoticeBar::show(const QString& cause, Level level, const QString& text, const QString& button,
                     std::function<void()> action) {
  cause_ = cause;
  level_ = level;
  action_ = std::move(action);
  label_->setText(text);
  button_->setText(button);
  button_->setVisible(!button.isEmpty());
  dress();
  setVisible(true);
}

QString NoticeBar::text() const {
  return isHidden() ? QString() : label_->text();
}

void NoticeBar::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) dress();
  QFrame::changeEvent(event);
}

void NoticeBar::dress() {
  const QColor colour = level_ == Level::error     ? theme().error
                        : level_ == Level::warning ? theme().warning
                                                   : theme().accent;
  symbol_->setPixmap(icon(level_ == Level::info ? "info" : "warning").pixmap(18, 18));
  const QString sheet = QStringLiteral("#noticeBar { background: %1; border: 0; border-left: 3px solid %2; }")
                            .arg(theme().panel.name(), colour.name());
  if (styleSheet() != sheet) setStyleSheet(sheet);  // setting it changes the palette again
}

}  // namespace clothlab
