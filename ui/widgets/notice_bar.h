// Messages over a view: each says what happened, with buttons for what would help and one that closes it. A
// message is of a kind ("divergence"): a later one takes the place of that of the same kind, and leaves all
// others where they are.
#pragma once

#include <QScrollArea>
#include <functional>
#include <map>
#include <vector>

class QBoxLayout;

namespace clothlab {

class NoticeRow;

/// What a button of a message does. The message is taken away first.
struct NoticeAction {
  QString text;
  std::function<void()> act;
};

class NoticeBar : public QScrollArea {
  Q_OBJECT

 public:
  enum class Level { info, warning, error };

  explicit NoticeBar(QWidget* parent = nullptr);
  /// Lies over the upper or the lower edge of `view`, inside it and beside its other children, and leaves it
  /// where it is.
  void layOver(QWidget* view, Qt::Edge edge);

  void show(const QString& kind, Level level, const QString& text, std::vector<NoticeAction> actions = {},
            const QString& details = {});
  void show(const QString& kind, Level level, const QString& text, const QString& button,
            std::function<void()> action) {
    show(kind, level, text, {{button, std::move(action)}});
  }
  /// For a state that is told again and again: a message that was closed stays away until its text is another
  /// one or it was withdrawn. Empty: withdraws it.
  void showState(const QString& kind, Level level, const QString& text,
                 std::vector<NoticeAction> actions = {});
  /// Takes the message of this kind away: it is over.
  void withdraw(const QString& kind);

  bool shows(const QString& kind) const { return rows_.contains(kind); }
  /// Of the message of this kind; without a kind of all messages, a line each at least.
  QString text(const QString& kind = {}) const;
  /// Of the newest message; empty: there is none.
  QString cause() const;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void close(const QString& kind);
  void place();

  QWidget* view_ = nullptr;
  Qt::Edge edge_ = Qt::TopEdge;
  QBoxLayout* column_;  ///< from the edge inwards: a new message moves no other
  std::map<QString, NoticeRow*> rows_;
  std::map<QString, QString> closed_;  ///< texts by their kind
};

}  // namespace clothlab
