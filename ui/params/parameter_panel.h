// The form of a scene: one section for each block, and a menu of blocks to add. Generated from the parameter
// declarations; edits go to the document, and its signals update the form.
#pragma once

#include <QWidget>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "document/lab_document.h"

class QLabel;
class QLineEdit;
class QMenu;
class QScrollArea;
class QToolButton;
class QVBoxLayout;

namespace clothlab {

class ParameterEditor;
class ParameterSection;

class ParameterPanel : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterPanel(LabDocument& document, QWidget* parent = nullptr);

  /// A muted line below a parameter, present or future; empty takes it away.
  /// With a `button` beside it, which noteButtonClicked tells of.
  void setNote(const std::string& path, const QString& note, const QString& button = {});
  void clearNotes();

  /// Whether blocks can be added and removed; true by default.
  void setBlocksEditable(bool editable);

  /// What "auto" comes to at present for a parameter that allows it, in its unit.
  void setAutoValue(const std::string& path, std::optional<double> value);

  /// Gives the search field the focus.
  void startSearch();

  /// Opens the parameter's section, scrolls to it and gives it the focus. False if the scene does not have
  /// it.
  bool reveal(const std::string& path);

  QSize sizeHint() const override { return {320, 640}; }
  QSize minimumSizeHint() const override { return {280, 200}; }

 Q_SIGNALS:
  void noteButtonClicked(const std::string& path);

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void makeHead();
  QWidget* makeAdd();
  QWidget* makeSearch();
  void filter();
  void focusFirstMatch();
  void makeScrollArea();
  void fillAddMenu();
  void add(const std::string& offer_path);
  void rebuild();
  void follow(const std::string& path);
  ParameterSection* makeSection(const cloth::Block& block);
  void showMesh(const std::string& block_path);
  void showRow(QWidget* row);
  void retire(ParameterSection* section);
  void orderTabs();
  void applyNotes(ParameterEditor& editor);
  ParameterEditor* editor(const std::string& path) const;

  LabDocument& document_;
  QToolButton* add_ = nullptr;
  QMenu* menu_ = nullptr;
  QLineEdit* search_ = nullptr;
  QLabel* nothing_ = nullptr;  ///< says that nothing matches
  QScrollArea* scroll_ = nullptr;
  QWidget* content_ = nullptr;
  QVBoxLayout* column_ = nullptr;
  std::vector<ParameterSection*> sections_;
  std::set<std::string> collapsed_;
  struct Note {
    QString text, button;
    bool operator==(const Note&) const = default;
  };
  std::map<std::string, Note> notes_;
  bool blocks_editable_ = true;
  std::map<std::string, double> auto_values_;
};

}  // namespace clothlab
