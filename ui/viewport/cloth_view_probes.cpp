// ClothView: the probe tool and the scene's probes beside the cloth.
#include <algorithm>

#include "cloth/cut_grid.h"
#include "theme/theme.h"
#include "viewport/cloth_view.h"
#include "viewport/probe_text.h"

namespace clothlab {
namespace {

std::size_t wanted_clicks(cloth::ProbeMeasure measure, bool is_mesh) {
  if (measure == cloth::ProbeMeasure::line) return is_mesh ? facts_of(measure).most_particles : 2;
  return facts_of(measure).most_particles;
}

}  // namespace

void ClothView::setSheet(const cloth::ClothSheet& sheet) {
  if (sheet == sheet_) return;
  sheet_ = sheet;
  forgetProbeClicks();
}

void ClothView::setProbeMeasure(cloth::ProbeMeasure measure) {
  if (measure == probe_measure_) return;
  probe_measure_ = measure;
  forgetProbeClicks();
}

void ClothView::forgetProbeClicks() {
  probe_clicks_.clear();
  repaintOver();
}

/// The clicked particles and the one under the cursor, which lies straight ahead on a line of a grid.
std::vector<cloth::ParticlePlace> ClothView::probePlaces(std::optional<int> next) const {
  std::vector<cloth::ParticlePlace> places = probe_clicks_;
  if (!next) return places;
  cloth::ParticlePlace place = place_of(sheet_, *next);
  const bool of_grid_line = probe_measure_ == cloth::ProbeMeasure::line && !sheet_.is_mesh();
  if (of_grid_line && !places.empty()) place = straight_end(sheet_, places.front(), place);
  if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
  return places;
}

void ClothView::clickProbe(int particle) {
  const std::vector<cloth::ParticlePlace> places = probePlaces(particle);
  const bool is_new = places.size() > probe_clicks_.size();
  const bool ends_chain = !is_new && sheet_.is_mesh() && probe_measure_ == cloth::ProbeMeasure::line &&
                          places.size() > 1 && place_of(sheet_, particle) == places.back();
  if (is_new && places.size() < wanted_clicks(probe_measure_, sheet_.is_mesh())) {
    probe_clicks_ = places;
    return repaintOver();
  }
  if (!is_new && !ends_chain) return;
  const cloth::Probe probe{.name = {}, .measure = probe_measure_, .particles = places};
  forgetProbeClicks();
  Q_EMIT probeWanted(probe);
}

/// Of the particles that a probe has chosen so far; a line of a grid with all between its ends.
std::vector<int> ClothView::previewParticles() const {
  const cloth::Probe probe{.name = {}, .measure = probe_measure_, .particles = probePlaces(hovered_)};
  const bool has_ends = probe.measure != cloth::ProbeMeasure::line || probe.particles.size() > 1;
  if (probe.particles.empty()) return {};
  if (has_ends) return probed_particles(sheet_, probe);
  return probed_particles(
      sheet_, {.name = {}, .measure = cloth::ProbeMeasure::particle, .particles = {probe.particles.front()}});
}

bool ClothView::sheetFits() const {
  return frame_ && static_cast<std::size_t>(particle_count(sheet_)) * 3 == frame_->positions.size();
}

QPolygonF ClothView::screenLine(const std::vector<int>& particles) const {
  QPolygonF line;
  for (const int particle : particles) line << screenPoint(particle);
  return line;
}

/// The list of those of the whole shape has its place; the labels at particles keep clear of it, wherever in
/// the scene they stand.
void ClothView::paintProbes(QPainter& painter) {
  paintProbesOf(true, painter);
  paintProbesOf(false, painter);
}

void ClothView::paintProbesOf(bool shape, QPainter& painter) {
  const Theme& look = theme();
  std::size_t value = 0;
  for (const cloth::ProbeReader::Probed& probed : frame_->probes) {
    const std::size_t count = facts_of(probed.probe.measure).values.size();
    if (value + count > frame_->probe_values.size()) break;
    const auto first = frame_->probe_values.begin() + static_cast<std::ptrdiff_t>(value);
    ProbeLabel label = probe_label(probed.probe, {first, first + static_cast<std::ptrdiff_t>(count)});
    value += count;
    if (probed.particles.empty() != shape) continue;
    if (!shape && !showsMode()) label.values.clear();  // in a small pane the values would cover the cloth
    if (shape)
      overlay_.shape_probe(painter, look, label);
    else
      overlay_.probe(painter, size(), look, screenLine(probed.particles), &label);
  }
}

void ClothView::paintProbeTool(QPainter& painter) {
  if (tool_ != Tool::probe || !sheetFits() || gesture_ == Gesture::orbit || gesture_ == Gesture::pan) return;
  const Theme& look = theme();
  const std::vector<int> particles = previewParticles();
  if (!particles.empty()) {
    overlay_.probe(painter, size(), look, screenLine(particles), nullptr);
    if (hovered_)
      overlay_.reading(painter, size(), look, screenPoint(particles.back()),
                       probe_preview(probe_measure_, particles, *frame_));
  }
  if (!clothIsOutOfSight())
    overlay_.hint(painter, size(), look, probe_hint(probe_measure_, probe_clicks_.size(), sheet_.is_mesh()));
}

}  // namespace clothlab
