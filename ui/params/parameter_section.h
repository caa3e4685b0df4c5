// One block of a scene as a section of the form: a header that opens and closes it, a button that removes the
// block if it can be removed, and an editor for each of its parameters.
#pragma once

#include <QWidget>
#include <string>
#include <vector>

#include "document/lab_document.h"

class QToolButton;
class QVBoxLayout;

namespace clothlab {

class ClothShapeRow;
class MaterialRow;
class ParameterEditor;
class SectionHeader;

class ParameterSection : public QWidget {
  Q_OBJECT

 public:
  ParameterSection(LabDocument& document, const cloth::Block& block, QWidget* parent = nullptr);

  const std::string& path() const { return path_; }
  /// Whether this section can show the block as it is: same title, same parameters.
  bool shows(const cloth::Block& block) const;

  void setCollapsed(bool collapsed);
  /// Shows the cross of a block that may go, or hides it; likewise what makes another block of it.
  void setRemovable(bool removable);

  /// Shows the rows that have every one of these words, or all where there are none or the title has them; as
  /// long as there are words, open. False if there is none: the section is hidden then.
  bool showMatching(const QStringList& words);

  void refresh();
  ParameterEditor* editor(const std::string& path) const;
  const std::vector<ParameterEditor*>& editors() const { return editors_; }
  QList<QWidget*> tabStops() const;
  void abandonEdits();

 Q_SIGNALS:
  void collapsedChanged(bool collapsed);
  void removeRequested();
  void meshChosen();    ///< and taken or refused; a message is at its place
  void materialSaid();  ///< something above its parameters

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void makeHead(const cloth::Block& block, QVBoxLayout& column);
  void makeBody(LabDocument& document, const cloth::Block& block, QVBoxLayout& column);

  std::string path_, title_;
  bool removable_ = true;
  SectionHeader* head_ = nullptr;
  QToolButton* cross_ = nullptr;
  QWidget* body_ = nullptr;
  ClothShapeRow* shape_ = nullptr;   ///< of a grid cloth
  MaterialRow* material_ = nullptr;  ///< of a grid's springs or material
  std::vector<ParameterEditor*> editors_;
};

}  // namespace clothlab
