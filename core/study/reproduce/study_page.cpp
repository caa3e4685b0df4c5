#include "study/reproduce/study_page.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "cloth/sums.h"
#include "contact/start_check.h"
#include "scene/builtin_scenes.h"
#include "simulation/step_batches.h"

namespace cloth {

void StudyPage::begin_part(const std::string& part, double done, double share) {
  part_ = part;
  done_ = done;
  share_ = share;
}

bool StudyPage::go_on(double fraction) {
  if (!result_.stopped && options_.progress &&
      !options_.progress({part_, done_ + share_ * std::clamp(fraction, 0.0, 1.0)}))
    result_.stopped = true;
  return !result_.stopped && !result_.io_error;
}

double StudyPage::number(const std::string& name, double value, const std::string& unit,
                         std::optional<double> expected) {
  result_.numbers.push_back({part_, name, unit, value, expected});
  return value;
}

void StudyPage::write(const std::string& file, const std::string& content) {
  if (result_.io_error) return;
  result_.io_error = folder_.write(file, content, file.ends_with(".csv"));
  if (!result_.io_error) result_.files.push_back(file);
}

void StudyPage::picture(const std::string& file, const Image& image, const std::string& text,
                        const HtmlText& caption, const std::string& command) {
  const std::vector<std::uint8_t> png = png_file(image);
  write(file + ".png", std::string(png.begin(), png.end()));
  page_.picture(png, text, caption, command.empty() ? part_command() : command);
}

void StudyPage::plot(const std::string& file, const LinePlot& plot, const HtmlText& caption) {
  const std::string svg = to_svg(plot);
  write(file + ".svg", svg);
  page_.figure(svg, caption, part_command());
}

std::string StudyPage::part_command() const {
  return fmt::format("clothlab-cli reproduce --only {} --out {}", part_, part_);
}

SceneRun scene_run(const std::string& name, const std::vector<std::string>& settings) {
  std::string command = "clothlab-cli run " + name;
  std::vector<Override> overrides;
  for (const std::string& setting : settings) {
    overrides.push_back(*parse_override(setting));
    const bool quoted = setting.find_first_of(" []\"") != std::string::npos;
    command += " --set " + (quoted ? "'" + setting + "'" : setting);
  }
  SceneReading reading =
      read_runnable_scene(find_builtin_scene(name)->text, name, overrides, {SceneFolder{"", true}});
  assert(reading.scene);
  return {*std::move(reading.scene), command + " --out " + name};
}

bool advance(Simulation& simulation, double time, StudyPage& study, double from, double to) {
  const double begin = simulation.time();
  const double almost = time - 0.5 * simulation.time_step();
  StepBatches batches(simulation, [&] {
    return !study.go_on(from + (to - from) * (simulation.time() - begin) / (time - begin));
  });
  while (simulation.time() < almost)
    if (!batches.run_to(simulation.state().step + steps_beyond(simulation, almost))) return false;
  return study.go_on(to);
}

Image beside(std::span<const Image> images) {
  constexpr int gap = 6;
  Image joined;
  for (const Image& image : images) {
    joined.width += image.width + (joined.width > 0 ? gap : 0);
    joined.height = image.height;
  }
  for (int row = 0; row < joined.height; ++row)
    for (std::size_t k = 0; k < images.size(); ++k) {
      if (k > 0) joined.pixels.insert(joined.pixels.end(), gap, Rgb{0xff, 0xff, 0xff});
      const auto start = images[k].pixels.begin() + std::ptrdiff_t{row} * images[k].width;
      joined.pixels.insert(joined.pixels.end(), start, start + images[k].width);
    }
  return joined;
}

double rms_distance(const Vec3Field& a, const Vec3Field& b) {
  const auto from = a.flat(), to = b.flat();
  const double sum = ordered_sum(from.size(), [&](std::size_t k) { return std::pow(from[k] - to[k], 2); });
  return std::sqrt(sum / static_cast<double>(a.size()));
}

std::vector<double> pairwise_orders(std::span<const double> errors) {
  std::vector<double> orders;
  for (std::size_t k = 1; k < errors.size(); ++k) orders.push_back(std::log2(errors[k - 1] / errors[k]));
  return orders;
}

HtmlTable number_table(const HtmlText& caption, const std::vector<std::string>& headers) {
  HtmlTable table{caption, {}, {}};
  for (const std::string& header : headers)
    table.columns.push_back({header, table.columns.empty() ? Align::left : Align::right});
  return table;
}

}  // namespace cloth
