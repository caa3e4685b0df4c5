// The members of study.json, each named once: the same lists serve its writer and its reader.
#pragma once

#include <algorithm>
#include <limits>

#include "io/json_entry.h"
#include "study/study_folder.h"

namespace cloth {

/// The members of an object: written, or read where there is an entry to read from.
class JsonFields {
 public:
  explicit JsonFields(nlohmann::ordered_json& into) : into_(&into) {}
  explicit JsonFields(const JsonEntry& from) : from_(from) {}

  template <class Value>
  void operator()(const char* key, Value& value) {
    if (into_)
      (*into_)[key] = value;
    else if constexpr (std::is_same_v<Value, double>)
      value = from_->at(key).number();
    else if constexpr (std::is_same_v<Value, bool>)
      value = from_->at(key).flag();
    else if constexpr (std::is_same_v<Value, std::string>)
      value = from_->at(key).text();
    else if constexpr (!std::is_const_v<Value>)
      value = from_->at(key).template whole<Value>(0, largest<Value>());
  }

  /// The fields of a member that is an object itself.
  JsonFields of(const char* key) const {
    return into_ ? JsonFields((*into_)[key]) : JsonFields(from_->at(key));
  }
  bool has(const char* key) const { return into_ || from_->has(key); }

 private:
  template <class Value>
  static double largest() {
    if (std::is_same_v<Value, int>) return 1e9;
    return std::min(largest_whole, static_cast<double>(std::numeric_limits<Value>::max()));
  }

  nlohmann::ordered_json* into_ = nullptr;
  std::optional<JsonEntry> from_;
};

template <class Study>  // WorkPrecision, const where it is written
void visit_options(JsonFields fields, Study& study) {
  fields("horizon_s", study.horizon);
  fields("repeats", study.repeats);
  if (fields.has("runs_per_method")) fields("runs_per_method", study.steps_per_method);
  fields("budget_s", study.budget);
}

template <class Reference>  // ReferenceSolution
void visit_reference(JsonFields fields, Reference& reference) {
  fields("smooth", reference.smooth);
  fields("first", reference.first);
  fields("second", reference.second);
  fields("failure", reference.failure);
  JsonFields floor = fields.of("floor");
  floor("rms_position_m", reference.floor.rms_position);
  floor("largest_position_m", reference.floor.largest_position);
  floor("rms_velocity_m_s", reference.floor.rms_velocity);
  fields("excited_frequency_per_s", reference.excited_frequency);
  fields("largest_kinetic_J", reference.largest_kinetic);
  fields("evaluations", reference.evaluations);
}

template <class StudiedAxis>  // StudyAxis
void visit_axis(JsonFields fields, StudiedAxis& axis) {
  bool logarithmic = axis.scale == AxisScale::logarithmic;
  fields("path", axis.path);
  fields("low", axis.low);
  fields("high", axis.high);
  fields("count", axis.count);
  fields("logarithmic", logarithmic);
  if constexpr (!std::is_const_v<StudiedAxis>)
    axis.scale = logarithmic ? AxisScale::logarithmic : AxisScale::linear;
}

template <class Options>  // StabilityOptions
void visit_stability(JsonFields fields, Options& options) {
  visit_axis(fields.of("x"), options.x);
  visit_axis(fields.of("y"), options.y);
  fields("full_size", options.full_size);
  JsonFields of_criterion = fields.of("criterion");
  auto& criterion = options.criterion;
  of_criterion("periods", criterion.periods);
  of_criterion("least_steps", criterion.least_steps);
  of_criterion("most_steps", criterion.max_steps);
  of_criterion("perturbation", criterion.perturbation);
  of_criterion("perturbation_seed", criterion.perturbation_seed);
  of_criterion("growth", criterion.growth);
  of_criterion("growth_factor", criterion.growth_factor);
  of_criterion("accuracy", criterion.accuracy);
}

}  // namespace cloth
