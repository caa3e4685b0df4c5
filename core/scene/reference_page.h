// The reference of all parameters, made from their declarations.
#pragma once

#include <string>

namespace cloth {

/// docs/parameters.md, as Markdown.
std::string reference_page();

}  // namespace cloth
