#include "bridge/energy_watch.h"

namespace clothlab {
namespace {

constexpr std::size_t max_kept = 4096;

}  // namespace

void EnergyWatch::add(const cloth::Measurement& measurement) {
  account_.add(measurement);
  if (rows_++ % stride_ == 0) kept_.push_back({measurement.step, account_});
  if (kept_.size() > max_kept) {
    for (std::size_t k = 0; 2 * k < kept_.size(); ++k) kept_[k] = kept_[2 * k];
    kept_.resize((kept_.size() + 1) / 2);
    stride_ *= 2;
  }
  if (!account_.is_doubtful_so_far() || account_.share() < 2 * said_share_) return;
  said_share_ = account_.share();
  notice_ = describe(account_);
}

void EnergyWatch::cut(std::int64_t step) {
  while (!kept_.empty() && kept_.back().step > step) kept_.pop_back();
  rows_ = static_cast<std::int64_t>(kept_.size()) * stride_;
  account_ = kept_.empty() ? cloth::EnergyAccount() : kept_.back().account;
  notice_ = account_.is_doubtful_so_far() ? describe(account_) : "";
  said_share_ = notice_.empty() ? 0 : account_.share();
}

}  // namespace clothlab
