// Fusion with our icons for what Qt's own dialogs show: folders, files and the buttons of file dialogs.
#pragma once

#include <QProxyStyle>

namespace clothlab {

class LabStyle : public QProxyStyle {
  Q_OBJECT

 public:
  LabStyle() : QProxyStyle(QStringLiteral("Fusion")) {}

  QIcon standardIcon(StandardPixmap which, const QStyleOption* option = nullptr,
                     const QWidget* widget = nullptr) const override;
};

}  // namespace clothlab
