// The menu of a parameter that is a number.
#pragma once

#include "document/lab_document.h"

class QToolButton;

namespace clothlab {

/// A small button with a menu: vary the parameter for a sweep or end that, its default, its path. It is
/// opened from the keyboard by the menu key on the parameter's slider.
QToolButton* make_parameter_menu(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

}  // namespace clothlab
