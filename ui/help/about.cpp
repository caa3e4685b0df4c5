#include "help/about.h"

#include <QObject>
#include <utility>
#include <vector>

#include "io/machine.h"
#include "kernels/instruction_set.h"
#include "viewport/gl/gl_probe.h"

namespace clothlab {
namespace {

QString opengl_text() {
  const GlAbilities& gl = gl_abilities();
  if (!gl.usable) return QObject::tr("not usable: %1").arg(gl.problem);
  return QStringLiteral("%1, %2").arg(gl.version, gl.renderer);
}

QString qt_text() {
  const QString running = QString::fromLatin1(qVersion()), built = QStringLiteral(QT_VERSION_STR);
  return running == built ? running : QObject::tr("%1 (built with %2)").arg(running, built);
}

}  // namespace

QString about_page() {
  const cloth::MachineFacts machine = cloth::machine_facts();
  const std::vector<std::pair<QString, QString>> rows{
      {QObject::tr("Clothlab"), QString::fromStdString(machine.version)},
      {QObject::tr("Qt"), qt_text()},
      {QObject::tr("OpenGL"), opengl_text()},
      {QObject::tr("Processor"),
       QObject::tr("%1, %2 logical cores").arg(QString::fromStdString(machine.processor)).arg(machine.cores)},
      {QObject::tr("Instruction set"), QString::fromLatin1(name_of(cloth::active_instruction_set()))},
      {QObject::tr("System"), QString::fromStdString(machine.operating_system)},
      {QObject::tr("Compiler"), QString::fromStdString(machine.compiler)}};
  QString page =
      QObject::tr(
          "<h1>Clothlab %1</h1><p>A lab for cloth simulation after Provot (1995): mass and springs, "
          "deformation rate, integrators to compare.</p><table cellspacing='0' cellpadding='3'>")
          .arg(QString::fromStdString(machine.version).toHtmlEscaped());
  for (const auto& [name, value] : rows)
    page +=
        QStringLiteral("<tr><td><b>%1</b>&nbsp;&nbsp;</td><td>%2</td></tr>").arg(name, value.toHtmlEscaped());
  return page + QObject::tr(
                    "</table><p>Source under the MIT licence. This program uses Qt Charts, so as a "
                    "distributed binary "
                    "it is under the GPL, version 3. See <a href='dependencies.md'>what Clothlab is built "
                    "from</a>.</p>");
}

}  // namespace clothlab
