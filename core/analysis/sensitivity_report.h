// Sensitivity for readers: plots and tables of Morris' effects and Sobol' indices.
#pragma once

#include <string>
#include <vector>

#include "design/sensitivity.h"
#include "report/html_page.h"
#include "report/line_plot.h"
#include "report/points/interval_bars.h"

namespace cloth {

/// sigma against mu*, a point with its interval for each parameter. `names`: of the parameters; `unit`: of
/// the output.
LinePlot morris_plot(const MorrisScreening& screening, const std::vector<std::string>& names,
                     const std::string& output, const std::string& unit);
HtmlTable morris_table(const MorrisScreening& screening, const std::vector<std::string>& names,
                       const std::string& unit);

/// First and total index, two bars for each parameter.
IntervalBars sobol_plot(const SobolIndices& indices, const std::vector<std::string>& names,
                        const std::string& output);
HtmlTable sobol_table(const SobolIndices& indices, const std::vector<std::string>& names);

/// What an index says in sentences: which parameter decides most, which does nothing that can be told from 0,
/// and how much of the variance interactions make.
std::vector<std::string> sentences_of(const SobolIndices& indices, const std::vector<std::string>& names,
                                      const std::string& output);
std::vector<std::string> sentences_of(const MorrisScreening& screening, const std::vector<std::string>& names,
                                      const std::string& output);

/// A heading, the sentences, the figure and its table.
void add_sensitivity(const SobolIndices& indices, const std::vector<std::string>& names,
                     const std::string& output, HtmlPage& page);
void add_sensitivity(const MorrisScreening& screening, const std::vector<std::string>& names,
                     const std::string& output, const std::string& unit, HtmlPage& page);

/// CSV: a row for each parameter: parameter,s,s_low,s_high,st,st_low,st_high
std::string sobol_csv(const SobolIndices& indices, const std::vector<std::string>& names);
/// parameter,mu,mu_star,mu_star_low,mu_star_high,sigma,effects
std::string morris_csv(const MorrisScreening& screening, const std::vector<std::string>& names);

}  // namespace cloth
