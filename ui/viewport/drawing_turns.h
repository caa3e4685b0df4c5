// Pictures that the processor draws are drawn one in each event of the window's thread, in turn: however many
// views there are, a click waits for one drawing at most.
#pragma once

#include <QObject>
#include <QTimer>
#include <deque>

namespace clothlab {

class DrawingTurns : public QObject {
  Q_OBJECT

 public:
  /// Who has something to draw.
  class Drawer {
   public:
    virtual void takeTurn() = 0;

   protected:
    ~Drawer() = default;
  };

  /// One for all views of the application.
  static DrawingTurns& ofTheApplication();

  /// `drawer` gets a turn in an event to come, after those that asked before; once, however often it asks.
  void ask(Drawer* drawer);
  /// It does not want one any more.
  void leave(Drawer* drawer);

 private:
  explicit DrawingTurns(QObject* parent);
  void next();

  std::deque<Drawer*> waiting_;
  QTimer timer_;  ///< runs only while somebody waits
};

}  // namespace clothlab
