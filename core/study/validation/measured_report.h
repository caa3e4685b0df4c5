// Rows of the validation that have no exact value, as tables: what each grid gives beside what was published.
#pragma once

#include <string>
#include <vector>

#include "report/html_page.h"
#include "study/validation/validation.h"

namespace cloth {

/// "within what was published", or by how many points outside; of the finest grid.
std::string in_band_words(const ValidationRow& row);

/// A line for each such row; empty where there is none.
std::string measured_text(const std::vector<ValidationRow>& rows);

/// Of one protocol.
HtmlTable measured_table(const std::string& protocol, const std::vector<ValidationRow>& rows);

}  // namespace cloth
