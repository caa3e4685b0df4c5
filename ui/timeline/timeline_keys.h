// The timeline's keys, wherever in its window the focus is: arrows, also with Shift, Home and End. What has a
// use for them itself keeps them: fields, sliders, lists, tables, tabs, and widgets that
// keeps_arrow_keys marks, such as charts.
#pragma once

#include <QObject>

namespace clothlab {

class TimelineTrack;

class TimelineKeys : public QObject {
  Q_OBJECT

 public:
  /// For as long as the track lives.
  explicit TimelineKeys(TimelineTrack* track);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  bool isMeant(const QObject* watched) const;

  TimelineTrack* track_;
};

}  // namespace clothlab
