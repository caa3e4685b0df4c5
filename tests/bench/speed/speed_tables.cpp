#include "bench/speed/speed_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/speed/bench_page.h"

namespace cloth::speed {
namespace {

std::string number_if(double value, bool there = true) {
  return there && value > 0 ? number(value) : "";
}

std::string quartiles(const Spread& spread) {
  return number(spread.low) + " to " + number(spread.high);
}

std::string title_of(const std::string& feature) {
  return feature_named(feature).title;
}

std::string name_of_method(const std::string& method) {
  return method == reference_method ? "reference kernel" : method;
}

/// "1", "4" or "5.3"
std::string count_text(double each_step) {
  return each_step == std::floor(each_step) ? fmt::format("{:.0f}", each_step)
                                            : fmt::format("{:.1f}", each_step);
}

std::string solver_text(const StepCost& row) {
  if (row.sweeps > 0) return count_text(row.sweeps) + " sweeps";
  if (row.velocity_iterations > 0) return count_text(row.velocity_iterations) + " velocity iterations";
  if (row.inner_steps > 1) return count_text(row.inner_steps) + " inner steps";
  if (row.linear_iterations > 0) return count_text(row.linear_iterations) + " linear iterations";
  return "";
}

TextTable step_table(const std::vector<StepCost>& rows, int size) {
  TextTable table;
  table.columns = {{"Method"},
                   {"With"},
                   {"Threads", true},
                   {"Time (ns)", true},
                   {"Quartiles (ns)", true},
                   {"/ reference", true},
                   {"/ bare", true},
                   {"/ divider", true},
                   {"/ memory", true},
                   {"Forces", true},
                   {"Solver, per step"},
                   {"Remark"}};
  for (const StepCost& row : rows) {
    if (row.size != size) continue;
    const std::vector<std::string> names{name_of_method(row.method), title_of(row.feature),
                                         std::to_string(row.threads)};
    if (row.samples == 0) {
      table.rows.push_back({names[0], names[1], names[2], "-", "", "", "", "", "", "", "", row.remark});
      continue;
    }
    const bool more = row.feature != bare_feature().name;
    table.rows.push_back({names[0], names[1], names[2], number(row.time.median), quartiles(row.time),
                          number(row.to_reference.median), number_if(row.to_bare.median, more),
                          number_if(row.to_divider), number_if(row.to_memory), count_text(row.evaluations),
                          solver_text(row), row.remark});
  }
  return table;
}

TextTable growth_table(const std::vector<Growth>& growth) {
  TextTable table;
  table.columns = {{"Method"}, {"With"},           {"Threads", true},
                   {"Sizes"},  {"Exponent", true}, {"Standard error", true}};
  for (const Growth& row : growth)
    table.rows.push_back(
        {name_of_method(row.method), title_of(row.feature), std::to_string(row.threads),
         fmt::format("{} to {}", row.smallest, row.largest), fmt::format("{:.3f}", row.exponent.value),
         row.exponent.points > 2 ? fmt::format("{:.3f}", row.exponent.standard_error) : "-"});
  return table;
}

TextTable yardstick_table(const Yardsticks& y) {
  TextTable table;
  table.columns = {{"Machine"}, {"Median", true}, {"Quartiles", true}, {"Unit"}};
  const auto add = [&](const std::string& what, const Spread& spread, const char* unit) {
    table.rows.push_back({what, fmt::format("{:.3f}", spread.median),
                          fmt::format("{:.3f} to {:.3f}", spread.low, spread.high), unit});
  };
  const auto throughput = [](const Spread& time) {
    const auto of = [](double ns) { return Yardsticks::bytes_per_element / ns; };
    return Spread{of(time.high), of(time.median), of(time.low), 0};
  };
  add("square root and division, scalar", y.scalar_root, "ns per double");
  add("square root and division, " + y.vectors, y.vector_root, "ns per double");
  add("memory, triad a = b + s c", throughput(y.triad), "GB/s");
  add("memory, update x += s v", throughput(y.update), "GB/s");
  if (y.cores > 1)
    add(fmt::format("{} cores, roots, each for itself", y.cores), y.together, "times one core");
  return table;
}

TextTable contact_table(const std::vector<ContactCost>& costs) {
  TextTable table;
  table.columns = {{"Scene"},
                   {"Particles"},
                   {"On"},
                   {"Touched", true},
                   {"Pairs", true},
                   {"Without (ns)", true},
                   {"With (ns)", true},
                   {"Quartiles (ns)", true},
                   {"With / without", true},
                   {"Remark"}};
  for (const ContactCost& cost : costs) {
    std::string on = cost.obstacle_triangles > 0 ? fmt::format("{} triangles", cost.obstacle_triangles) : "";
    if (cost.with_itself) on += on.empty() ? "itself" : ", itself";
    std::vector<std::string> row{cost.scene, fmt::format("{} x {}", cost.columns, cost.rows), on};
    if (cost.with.median > 0)
      for (const std::string& cell :
           {std::to_string(cost.touched), std::to_string(cost.pairs), number(cost.without.median),
            number(cost.with.median), quartiles(cost.with), number(cost.ratio.median)})
        row.push_back(cell);
    row.resize(table.columns.size() - 1);
    row.push_back(cost.remark);
    table.rows.push_back(row);
  }
  return table;
}

TextTable scene_table(const std::vector<SceneSpeed>& scenes, int size) {
  TextTable table;
  table.columns = {{"Scene"},
                   {"Method"},
                   {"Particles", true},
                   {"Time step (s)", true},
                   {"Simulated (s)", true},
                   {"of (s)", true},
                   {"Simulated / stepping", true},
                   {"Per particle and step (ns)", true},
                   {"Bare (ns)", true},
                   {"/ bare", true},
                   {"Remark"}};
  for (const SceneSpeed& scene : scenes) {
    if (scene.size != size) continue;
    table.rows.push_back(
        {scene.name, scene.method,
         scene.rows > 0 ? fmt::format("{} x {}", scene.columns, scene.rows) : std::to_string(scene.particles),
         fmt::format("{:.4g}", scene.time_step), number(scene.simulated), number(scene.duration),
         number(scene.speed()), number(scene.nanoseconds), number(scene.bare), number(scene.to_bare()),
         scene.remark});
  }
  return table;
}

TextTable scene_growth_table(const std::vector<SceneGrowth>& growth) {
  TextTable table;
  table.columns = {{"Scene"}, {"Particles"}, {"Exponent", true}, {"Standard error", true}};
  for (const SceneGrowth& row : growth)
    table.rows.push_back(
        {row.name, fmt::format("{} to {}", row.smallest, row.largest),
         fmt::format("{:.3f}", row.exponent.value),
         row.exponent.points > 2 ? fmt::format("{:.3f}", row.exponent.standard_error) : "-"});
  return table;
}

TextTable memory_table(const std::vector<MemoryCost>& memory) {
  TextTable table;
  table.columns = {{"Method"},
                   {"With"},
                   {"Size"},
                   {"Held (bytes per particle)", true},
                   {"Peak (bytes per particle)", true}};
  const auto bytes = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.0f}", *value) : "-";
  };
  for (const MemoryCost& row : memory)
    table.rows.push_back({row.method, feature_named(row.feature).title, fmt::format("{0} x {0}", row.size),
                          bytes(row.held), bytes(row.peak)});
  return table;
}

TextTable start_table(const std::vector<StartCost>& starts) {
  TextTable table;
  table.columns = {{"Start"},         {"Time (ms)", true}, {"Quartiles (ms)", true}, {"Least (ms)", true},
                   {"Repeats", true}, {"Remark"}};
  for (const StartCost& row : starts)
    table.rows.push_back({row.what, row.samples > 0 ? number(row.milliseconds.median) : "-",
                          row.samples > 0 ? quartiles(row.milliseconds) : "",
                          row.samples > 0 ? number(row.milliseconds.least) : "", std::to_string(row.samples),
                          row.remark});
  return table;
}

constexpr const char* step_legend =
    R"(A cloth of N x N particles hung by two corners, springs in six directions, gravity, after {} s of hanging. Time:
per particle and step, median and quartiles of {} interleaved repeats; processor time for one thread, wall time for
more. Divided by: reference, the time of semi-implicit Euler in textbook code on index pairs; bare, the method's own step
without the addition; divider, exact roots and divisions at {} ns per spring and force evaluation; memory, 96 bytes per
particle at {} GB/s. The last two are one core's, as are the machine's figures but the last, which is what threads can gain at
most; a cloth in the caches may be below memory, a kernel that refines
estimates of roots below divider. Forces: evaluations per step.)";

void add_steps(Page& page, const SpeedReport& report) {
  page.heading("A step");
  page.paragraph(fmt::format(step_legend, hanging_time, report.repeats,
                             number(report.yardsticks.vector_root.median),
                             number(report.yardsticks.update_throughput())));
  page.table(yardstick_table(report.yardsticks));
  std::vector<int> sizes;
  for (const StepCost& row : report.rows)
    if (std::find(sizes.begin(), sizes.end(), row.size) == sizes.end()) sizes.push_back(row.size);
  for (const int size : sizes) {
    page.heading(fmt::format("{0} x {0}", size));
    page.table(step_table(report.rows, size));
  }
  page.heading("Growth");
  page.paragraph(
      "The power of the number of particles by which the time of a step, or of an inner step where a method "
      "takes several, grows: least squares over the lower quartiles.");
  page.table(growth_table(report.growth));
}

void add_scenes(Page& page, const SpeedReport& report) {
  page.heading("The built-in scenes");
  page.paragraph(
      "From the start, each with its own method. Bare: Verlet's step of a grid of as many rows and columns "
      "(of "
      "a mesh, of a square of as many particles) with springs in six directions and gravity alone, in turns "
      "with the scene, and the median of its turns.");
  std::vector<int> sizes;
  for (const SceneSpeed& scene : report.scenes)
    if (std::find(sizes.begin(), sizes.end(), scene.size) == sizes.end()) sizes.push_back(scene.size);
  std::sort(sizes.begin(), sizes.end());
  for (const int size : sizes) {
    if (size > 0) page.heading(fmt::format("The scenes with {} particles along the longer side", size));
    if (size == 0 && sizes.size() > 1) page.heading("Scenes that are not refined");
    page.table(scene_table(report.scenes, size));
  }
  if (report.scene_growth.empty()) return;
  page.heading("Growth of the scenes");
  page.paragraph("The power of the number of particles by which the time of a step grows, by least squares.");
  page.table(scene_growth_table(report.scene_growth));
}

std::string built(const SpeedReport& report, bool markdown) {
  Page page(markdown);
  const MachineFacts& machine = report.machine;
  page.paragraph(fmt::format("Clothlab {}, {}, {}; {}, {} cores", machine.version, machine.compiler,
                             machine.build_type, machine.processor, machine.cores));
  if (!report.complete) page.paragraph("Interrupted: this is what was finished.");
  if (!report.rows.empty()) add_steps(page, report);
  if (!report.contact.empty()) {
    page.heading("Contact");
    page.paragraph(
        "Processor time of a whole step per particle, from a state in which the cloth lies on something, "
        "without "
        "obstacles and self-contact and with them.");
    page.table(contact_table(report.contact));
  }
  if (!report.scenes.empty()) add_scenes(page, report);
  if (!report.memory.empty()) {
    page.heading("Memory");
    page.paragraph("After the first step: what is held, and the most resident memory until then.");
    page.table(memory_table(report.memory));
  }
  if (!report.starts.empty()) {
    page.heading("Start");
    page.table(start_table(report.starts));
  }
  std::string text = page.take();
  return markdown ? text.substr(1) : text;
}

}  // namespace

std::string speed_text(const SpeedReport& report) {
  return built(report, false);
}

std::string speed_markdown(const SpeedReport& report) {
  return built(report, true);
}

}  // namespace cloth::speed
