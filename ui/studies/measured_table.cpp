#include "studies/measured_table.h"

#include <QFile>
#include <QFileInfo>
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/csv.h"

namespace clothlab {
namespace {

constexpr qint64 largest_table = 64 << 20;  // B
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// Without comments, and with commas between fields.
std::string plain_csv(const QByteArray& bytes, bool& has_commas) {
  QStringList lines;
  for (const QString& line : QString::fromUtf8(bytes).split('\n'))
    if (const QString trimmed = line.trimmed(); !trimmed.isEmpty() && !trimmed.startsWith('#'))
      lines << trimmed;
  if (lines.isEmpty()) return {};
  const QChar separator = lines.front().contains(';') ? ';' : lines.front().contains('\t') ? '\t' : ',';
  has_commas = separator != ',';
  if (!has_commas) return lines.join('\n').toStdString();
  for (QString& line : lines) line = line.replace(',', '.').replace(separator, ',');
  return lines.join('\n').toStdString();
}

/// The number of a field, or false.
bool read_number(const std::string& field, double& number) {
  const QString text = QString::fromStdString(field).trimmed();
  number = no_value;
  if (text.isEmpty()) return true;
  bool is_number = false;
  number = QLocale::c().toDouble(text, &is_number);
  return is_number && std::isfinite(number);
}

QString in_file(const QString& file, const QString& sentence) {
  return QObject::tr("%1: %2").arg(QFileInfo(file).fileName(), sentence);
}

}  // namespace

std::variant<MeasuredTable, QString> read_measured_table(const QString& name) {
  QFile file(name);
  if (!file.open(QIODevice::ReadOnly)) return in_file(name, file.errorString() + '.');
  if (file.size() > largest_table) return in_file(name, QObject::tr("is larger than 64 MB."));
  bool has_commas = false;
  const cloth::CsvTable csv = cloth::parse_csv(plain_csv(file.readAll(), has_commas));
  if (csv.header.size() < 2)
    return in_file(name, QObject::tr("must have a header and at least two columns: the times and what was "
                                     "measured at them."));
  MeasuredTable table{.file = name, .names = csv.header, .columns = {}};
  table.columns.resize(csv.header.size());
  double ignored = 0;
  if (std::all_of(csv.header.begin(), csv.header.end(),
                  [&](const std::string& field) { return read_number(field, ignored); }))
    return in_file(name, QObject::tr("begins with numbers: its first line must name the columns."));
  for (std::size_t r = 0; r < csv.rows.size(); ++r) {
    const auto& row = csv.rows[r];
    if (row.size() != csv.header.size())
      return in_file(name, QObject::tr("row %1 has %2 fields, and the header has %3.")
                               .arg(r + 1)
                               .arg(row.size())
                               .arg(csv.header.size()));
    for (std::size_t c = 0; c < row.size(); ++c) {
      double value = 0;
      if (!read_number(row[c], value))
        return in_file(name, QObject::tr("row %1, column %2: “%3” is not a number.")
                                 .arg(r + 1)
                                 .arg(QString::fromStdString(csv.header[c]))
                                 .arg(QString::fromStdString(row[c])));
      table.columns[c].push_back(value);
    }
  }
  if (csv.rows.size() < 2) return in_file(name, QObject::tr("must have at least two rows of values."));
  return table;
}

std::size_t likely_time_column(const MeasuredTable& table) {
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    const QString name = QString::fromStdString(table.names[c]).trimmed().toLower();
    if (name == "t" || name.startsWith("time") || name.startsWith("t (") || name.startsWith("t [")) return c;
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (std::is_sorted(table.columns[c].begin(), table.columns[c].end())) return c;
  return 0;
}

}  // namespace clothlab
