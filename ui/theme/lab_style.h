// Fusion with our icons for what Qt's own dialogs show: folders, files and the buttons of file dialogs; and
// with columns of tables that keep no more room than the mark of the sorted one needs.
#pragma once

#include <QProxyStyle>

namespace clothlab {

class LabStyle : public QProxyStyle {
  Q_OBJECT

 public:
  LabStyle() : QProxyStyle(QStringLiteral("Fusion")) {}

  QIcon standardIcon(StandardPixmap which, const QStyleOption* option = nullptr,
                     const QWidget* widget = nullptr) const override;
  QSize sizeFromContents(ContentsType type, const QStyleOption* option, const QSize& size,
                         const QWidget* widget) const override;
};

}  // namespace clothlab
