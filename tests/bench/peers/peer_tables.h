// A report of peers as text, Markdown and JSON.
#pragma once

#include <string>

#include "bench/peers/peer_study.h"

namespace cloth::peers {

std::string peer_text(const PeerReport& report);
std::string peer_markdown(const PeerReport& report);

/// bench.json
std::string peer_json(const PeerReport& report);

/// The errors of the second table, in m: the decades between the largest and the least error that was found,
/// and above what the reference is known to, from the largest.
std::vector<double> error_decades(const PeerScene& scene);

}  // namespace cloth::peers
