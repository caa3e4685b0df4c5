#include "document/save_dialog.h"

#include <QAbstractItemView>
#include <QCoreApplication>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>
#include <QRegularExpression>
#include <algorithm>

#include "document/result_files.h"

namespace clothlab {
namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("SaveDialog", text);
}

void refuse(QWidget* parent, const QString& title, const QString& path, const std::vector<FileKind>& kinds) {
  QStringList offered;
  for (const FileKind& kind : kinds) offered << kind.suffixes;
  QMessageBox::warning(parent, title,
                       tr("\"%1\" was not saved: the suffix %2 is not offered here. Offered: %3.")
                           .arg(QFileInfo(path).fileName(), suffix_of(path), offered.join(", ")));
}

/// As QFileDialog::selectFile(), without a selection in the list of files: a whole path that is typed would
/// lose against that.
void suggest(QFileDialog& dialog, const QString& path) {
  dialog.selectFile(path);
  for (QAbstractItemView* list : dialog.findChildren<QAbstractItemView*>())
    if (list->selectionModel()) list->clearSelection();
}

bool may_replace(QWidget* parent, const QString& title, const QString& path) {
  QMessageBox question(
      QMessageBox::Question, title,
      tr("There is a file \"%1\" already, in %2. Replace it?")
          .arg(QFileInfo(path).fileName(), QDir::toNativeSeparators(QFileInfo(path).absolutePath())),
      QMessageBox::Cancel, parent);
  const QPushButton* replace = question.addButton(tr("Replace"), QMessageBox::AcceptRole);
  question.setDefaultButton(QMessageBox::Cancel);
  question.exec();
  return question.clickedButton() == replace;
}

}  // namespace

QString FileKind::filter() const {
  QStringList patterns;
  for (const QString& suffix : suffixes) patterns << '*' + suffix;
  return QStringLiteral("%1 (%2)").arg(name, patterns.join(' '));
}

QString suffix_of(const QString& path) {
  static const QRegularExpression suffix(
      QStringLiteral(R"((\.(scene|session|compare)\.json|\.[a-z0-9]*[a-z][a-z0-9]*)$)"),
      QRegularExpression::CaseInsensitiveOption);
  return suffix.match(QFileInfo(path).fileName()).captured().toLower();
}

QString ask_where_to_save(QWidget* parent, const QString& title, const std::vector<FileKind>& kinds,
                          const QString& suggestion) {
  QStringList filters;
  for (const FileKind& kind : kinds) filters << kind.filter();
  QFileDialog dialog(parent, title);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setOption(QFileDialog::DontConfirmOverwrite);  // the final name is asked about, not the one typed
  dialog.setNameFilters(filters);
  const QString kind = kinds.front().suffixes.front().mid(1);
  if (!suggestion.isEmpty())
    suggest(dialog, suggestion);
  else if (const QString folder = last_folder(kind); !folder.isEmpty())
    dialog.setDirectory(folder);
  while (dialog.exec() == QDialog::Accepted) {
    QString path = dialog.selectedFiles().value(0);
    suggest(dialog, path);
    const QString suffix = suffix_of(path);
    const auto is_of = [&](const FileKind& one) { return one.suffixes.contains(suffix); };
    if (suffix.isEmpty()) {
      const auto chosen = std::max<qsizetype>(0, filters.indexOf(dialog.selectedNameFilter()));
      path += kinds[static_cast<std::size_t>(chosen)].suffixes.front();
    } else if (std::none_of(kinds.begin(), kinds.end(), is_of)) {
      refuse(parent, title, path, kinds);
      continue;
    }
    if (QFileInfo::exists(path) && !may_replace(parent, title, path)) continue;
    remember_folder(kind, path);
    return path;
  }
  return {};
}

QString saved_in(const QString& what, const QString& path) {
  return tr("Saved the %1 in %2").arg(what, QDir::toNativeSeparators(path));
}

}  // namespace clothlab
