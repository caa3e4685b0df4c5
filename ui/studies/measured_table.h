// A table of measured values as people have it: any CSV file with a header and columns of numbers.
#pragma once

#include <QString>
#include <string>
#include <variant>
#include <vector>

namespace clothlab {

struct MeasuredTable {
  QString file;
  std::vector<std::string> names;            ///< of the columns
  std::vector<std::vector<double>> columns;  ///< all of one length; an empty field is not a number
};

/// The table, or one sentence with the file, the place, the value and the rule. A separator of ';' or a tab
/// is taken, too, and with them a decimal comma; lines that begin with '#' are left out.
std::variant<MeasuredTable, QString> read_measured_table(const QString& file);

/// The column that most likely has the times: one whose name says so, else the first that ascends.
std::size_t likely_time_column(const MeasuredTable& table);

}  // namespace clothlab
