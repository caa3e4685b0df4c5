// The dialog that opens a built-in scene or comparison: cards with a picture, a title and a sentence, grouped
// by purpose. A click or Enter opens; arrows select; what is typed leaves only the cards with these words.
#pragma once

#include <QDialog>

class QLineEdit;
class QListWidget;

namespace clothlab {

class SceneChooser : public QDialog {
  Q_OBJECT

 public:
  /// Begins with this scene or comparison selected; with the first one if there is none of that name.
  explicit SceneChooser(const QString& selected, QWidget* parent);

 Q_SIGNALS:
  void chosen(const QString& name);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addEntries();
  void select(const QString& name);
  void find(const QString& words);

  QLineEdit* words_;
  QListWidget* list_;
};

}  // namespace clothlab
