// What every part of the reproduction writes to: page, files, numbers, progress.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "io/result_folder.h"
#include "picture/picture.h"
#include "report/html_page.h"
#include "report/line_plot.h"
#include "simulation/simulation.h"
#include "study/reproduce.h"

namespace cloth {

/// The methods of the source report.
inline constexpr std::array<const char*, 3> report_methods{"semi-implicit-euler", "rk4", "verlet"};

/// Pictures of cloth that stand side by side [px].
inline constexpr int panel_width = 480, panel_height = 420;
inline constexpr double panel_aspect = static_cast<double>(panel_width) / panel_height;

class StudyPage {
 public:
  /// `folder` is claimed.
  StudyPage(const ReproduceOptions& options, ResultFolder& folder, HtmlPage& page, ReproduceResult& result)
      : options_(options), folder_(folder), page_(page), result_(result) {}

  HtmlPage& page() { return page_; }

  /// The part that follows, from `done` to `done + share` of the whole.
  void begin_part(const std::string& part, double done, double share);
  /// `fraction` of the part is done. False: stop.
  bool go_on(double fraction);

  /// Keeps a number for the result and gives it back.
  double number(const std::string& name, double value, const std::string& unit = {},
                std::optional<double> expected = {});
  /// `file` without ending; alternative text, caption, and the commands that give the same.
  void picture(const std::string& file, const Image& image, const std::string& text, const HtmlText& caption,
               const std::string& command = {});
  void plot(const std::string& file, const LinePlot& plot, const HtmlText& caption);
  void write(const std::string& file, const std::string& content);

  /// What makes this part alone.
  std::string part_command() const;

 private:
  const ReproduceOptions& options_;
  ResultFolder& folder_;
  HtmlPage& page_;
  ReproduceResult& result_;
  std::string part_;
  double done_ = 0, share_ = 1;
};

/// A built-in scene with settings, and the command that runs it.
struct SceneRun {
  Scene scene;
  std::string command;
};
/// `settings` are PATH=VALUE. Precondition: the scene exists and the settings are valid.
SceneRun scene_run(const std::string& name, const std::vector<std::string>& settings = {});

/// Steps until `time`, telling progress from `from` to `to`. False where it was stopped or has diverged.
bool advance(Simulation& simulation, double time, StudyPage& study, double from, double to);

/// Pictures of one height side by side, a thin gap between them.
Image beside(std::span<const Image> images);

/// sqrt(mean |a_i - b_i|^2) in m
double rms_distance(const Vec3Field& a, const Vec3Field& b);

/// log2 of the ratios of errors whose steps halve.
std::vector<double> pairwise_orders(std::span<const double> errors);

/// Right-aligned but for the first.
HtmlTable number_table(const HtmlText& caption, const std::vector<std::string>& headers);

// The parts.
void reproduce_springs(StudyPage& study);
void reproduce_deformation(StudyPage& study);
void reproduce_wind(StudyPage& study);
void reproduce_methods(StudyPage& study);
void reproduce_obstacles(StudyPage& study);
void reproduce_table(StudyPage& study);
void reproduce_equal_error(StudyPage& study);
void reproduce_errata(StudyPage& study);

}  // namespace cloth
