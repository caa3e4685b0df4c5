#include "bench/solvers/solver_study.h"

#include <algorithm>

#include "bench/solvers/linear_subject.h"

namespace cloth::solvers {
namespace {

using speed::Spread;
using speed::Subject;

Subjects all_subjects(const NewtonSystem& system) {
  Subjects subjects = our_subjects(system);
  const auto take = [&](Subjects more) {
    for (auto& subject : more) subjects.push_back(std::move(subject));
  };
#ifdef CLOTHLAB_CHOLMOD
  take(cholmod_subjects(system));
#endif
#ifdef CLOTHLAB_HYPRE
  take(hypre_subjects(system));
#endif
  (void)take;
  return subjects;
}

/// The loosest tolerance, by steps of a half, with which the residual is as small as wanted: solvers measure
/// in norms of their own.
double tolerance_for(LinearSubject& subject, const NewtonSystem& system, double wanted, SolverRow& row) {
  Vec3Field solution(system.right_hand_side.size());
  double tolerance = 1e3 * wanted;
  for (int trial = 0; trial < 40; ++trial, tolerance /= 2) {
    row.iterations = subject.solve(tolerance, solution);
    if (row.iterations < 0) break;
    row.residual = system.relative_residual(solution);
    if (row.residual <= wanted) return tolerance;
    if (subject.is_direct()) break;
  }
  row.failure = row.iterations < 0 ? "did not converge" : "did not become as exact";
  return 0;
}

class OneSystem {
 public:
  OneSystem(const SolverOptions& options, ClothShape shape, int size)
      : options_(options), system_(newton_system(shape, size)), subjects_(all_subjects(*system_)) {
    table_.shape = shape;
    table_.size = size;
    table_.iteration = system_->iteration;
    table_.is_exact = system_->is_exact;
    table_.compressed_part = system_->compressed_part;
    for (const auto pinned : system_->system.pinned) table_.unknowns += pinned ? 0 : 3;
  }

  bool run(const speed::TimingProgress& progress) {
    for (const auto& subject : subjects_) prepare(*subject);
    speed::TimingPlan plan{.repeats = options_.repeats, .moment = 0.02, .budget = 6};
    if (options_.quick) plan.moment = 0.001, plan.budget = 0.05;
    const bool finished = time_interleaved(timed_, plan, progress);
    for (std::size_t k = 0; k < timed_.size(); ++k) *places_[k](table_) = spread_of(timed_[k]);
    return finished;
  }
  const SolverTable& table() const { return table_; }

 private:
  using Place = std::function<Spread*(SolverTable&)>;

  void prepare(LinearSubject& subject) {
    const std::size_t at = table_.rows.size();
    SolverRow& row = table_.rows.emplace_back();
    row.name = subject.name();
    row.library = subject.library();
    const bool analyses = subject.analyse();
    const bool converts = subject.convert();
    if (!subject.set_up()) {
      row.failure = "could not be set up";
      return;
    }
    const double tolerance = tolerance_for(subject, *system_, options_.residual, row);
    if (!row.failure.empty()) return;
    const auto add = [&](const char* phase, Spread SolverRow::*spread, std::function<bool()> work) {
      Subject timed{.name = row.name + ", " + phase, .scale = 1e3, .run = {}};
      timed.run = [work](int times) {
        for (int k = 0; k < times; ++k)
          if (!work()) return false;
        return true;
      };
      timed_.push_back(std::move(timed));
      places_.push_back([at, spread](SolverTable& table) { return &(table.rows[at].*spread); });
    };
    auto solution = std::make_shared<Vec3Field>(system_->right_hand_side.size());
    if (analyses)
      add("analysis", &SolverRow::analysis, [&subject] {
        subject.analyse();
        return true;
      });
    if (converts) add("conversion", &SolverRow::conversion, [&subject] { return subject.convert(); });
    add("set-up", &SolverRow::set_up, [&subject] { return subject.set_up(); });
    add("solve", &SolverRow::solve,
        [&subject, tolerance, solution] { return subject.solve(tolerance, *solution) >= 0; });
  }

  const SolverOptions& options_;
  std::unique_ptr<NewtonSystem> system_;
  Subjects subjects_;
  SolverTable table_;
  std::vector<Subject> timed_;
  std::vector<Place> places_;
};

}  // namespace

const SolverRow* SolverTable::best_of_ours() const {
  const SolverRow* best = nullptr;
  for (const SolverRow& row : rows)
    if (row.is_ours() && row.failure.empty() && (!best || row.whole() < best->whole())) best = &row;
  return best;
}

std::vector<std::string> missing_libraries() {
  std::vector<std::string> missing;
#ifndef CLOTHLAB_CHOLMOD
  missing.push_back("libsuitesparse-dev");
#endif
#ifndef CLOTHLAB_HYPRE
  missing.push_back("libhypre-dev");
#endif
  return missing;
}

SolverReport study_solvers(const SolverOptions& options) {
  SolverReport report;
  report.machine = machine_facts();
  report.residual = options.residual;
  report.repeats = options.repeats;
  report.missing = missing_libraries();
  const double all = std::size(cloth_shapes) * static_cast<double>(options.sizes.size());
  double done = 0;
  for (const int size : options.sizes)
    for (const ClothShape shape : cloth_shapes) {
      const auto goes_on = [&](double fraction, const std::string& name) {
        return !options.progress ||
               options.progress((done + fraction) / all, std::to_string(size) + ", " + name);
      };
      if (!goes_on(0, "the system")) return report;
      OneSystem system(options, shape, size);
      const bool finished = system.run(goes_on);
      report.tables.push_back(system.table());
      if (options.partial) options.partial(report);
      if (!finished) return report;
      done += 1;
    }
  report.complete = true;
  return report;
}

}  // namespace cloth::solvers
