#include "theme/lab_style.h"

#include <QStyleOption>

#include "theme/theme.h"

namespace clothlab {
namespace {

const char* name_of(QStyle::StandardPixmap which) {
  switch (which) {
    case QStyle::SP_FileDialogBack:
    case QStyle::SP_ArrowBack:
    case QStyle::SP_ArrowLeft:
      return "arrow-left";
    case QStyle::SP_ArrowForward:
    case QStyle::SP_ArrowRight:
      return "arrow-right";
    case QStyle::SP_FileDialogToParent:
      return "arrow-up";
    case QStyle::SP_FileDialogNewFolder:
      return "folder-new";
    case QStyle::SP_FileDialogListView:
      return "list";
    case QStyle::SP_FileDialogDetailedView:
      return "list-details";
    case QStyle::SP_DirIcon:
    case QStyle::SP_DirOpenIcon:
    case QStyle::SP_DirClosedIcon:
    case QStyle::SP_DirHomeIcon:
    case QStyle::SP_DirLinkIcon:
      return "folder";
    case QStyle::SP_FileIcon:
    case QStyle::SP_FileLinkIcon:
      return "file";
    case QStyle::SP_ComputerIcon:
    case QStyle::SP_DesktopIcon:
    case QStyle::SP_DriveHDIcon:
      return "computer";
    default:
      return nullptr;
  }
}

}  // namespace

QIcon LabStyle::standardIcon(StandardPixmap which, const QStyleOption* option, const QWidget* widget) const {
  const char* own = name_of(which);
  return own ? icon(QString::fromLatin1(own)) : QProxyStyle::standardIcon(which, option, widget);
}

/// Fusion keeps twice as much for the mark, which says by what a table is sorted.
QSize LabStyle::sizeFromContents(ContentsType type, const QStyleOption* option, const QSize& size,
                                 const QWidget* widget) const {
  const auto* header = qstyleoption_cast<const QStyleOptionHeader*>(option);
  if (type != CT_HeaderSection || !header) return QProxyStyle::sizeFromContents(type, option, size, widget);
  constexpr int room_for_mark = 8;  // px, beside the padding
  QStyleOptionHeader unsorted = *header;
  unsorted.sortIndicator = QStyleOptionHeader::None;
  return QProxyStyle::sizeFromContents(type, &unsorted, size, widget) + QSize(room_for_mark, 0);
}

}  // namespace clothlab
