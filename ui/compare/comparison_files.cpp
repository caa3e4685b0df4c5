#include "compare/comparison_files.h"

#include <QFileInfo>
#include <QObject>
#include <QStringList>

#include "compare/builtin_comparisons.h"
#include "compare/comparison_json.h"
#include "io/text_file.h"
#include "measure/stability_limit.h"

namespace clothlab {
namespace {

OpenedComparison read_text(const std::string& text, const std::string& place, const QString& path) {
  cloth::ComparisonReading reading = cloth::read_comparison(text, place);
  OpenedComparison opened{std::move(reading.comparison), path, {}};
  QStringList lines;
  for (const cloth::Problem& problem : reading.problems) lines << QString::fromStdString(problem.text());
  opened.problems = lines.join('\n');
  return opened;
}

}  // namespace

OpenedComparison open_comparison(const QString& name) {
  const QFileInfo file(name);
  if (file.isFile()) {
    std::string text;
    if (const auto error = cloth::read_text_file(name.toStdString(), text))
      return {std::nullopt, name, QString::fromStdString(error->text())};
    return read_text(text, file.fileName().toStdString(), file.absoluteFilePath());
  }
  if (const cloth::BuiltinComparison* builtin = cloth::find_builtin_comparison(name.toStdString()))
    return read_text(builtin->text, builtin->name, {});
  return {std::nullopt, name,
          QObject::tr("%1: there is neither a file nor a built-in comparison of this name").arg(name)};
}

QString save_comparison_file(const cloth::Comparison& comparison, const QString& path) {
  const auto error = cloth::write_text_file(path.toStdString(), cloth::write_comparison(comparison));
  return error ? QString::fromStdString(error->text()) : QString();
}

bool is_comparison_name(const QString& name) {
  return name.endsWith(".compare.json") ||
         (!QFileInfo::exists(name) && cloth::find_builtin_comparison(name.toStdString()));
}

cloth::Comparison comparison_of_scene(const cloth::Scene& scene) {
  constexpr std::size_t panes = 3;
  std::vector<std::string> methods{scene.integrator.method};
  for (const char* method : {"verlet", "semi-implicit-euler", "rk4"})
    if (methods.size() < panes && methods.front() != method) methods.emplace_back(method);
  cloth::Comparison comparison{.title = {}, .scene = scene, .panes = cloth::panes_for(methods)};
  const auto& step = scene.integrator.time_step;
  for (cloth::Pane& pane : comparison.panes) {
    const std::string& method = std::get<std::string>(pane.own.front().value);
    const bool too_long = step && cloth::stable_step(method, scene).value_or(0) <= *step;
    if (too_long && method != scene.integrator.method)
      set_own(pane, "integrator.time_step", std::string("auto"));
  }
  return comparison;
}

}  // namespace clothlab
