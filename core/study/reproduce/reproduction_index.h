// reproduce.json: which parts of a reproduction are finished, and, until all are, what they put on the page.
#pragma once

#include <nlohmann/json.hpp>

#include "io/result_folder.h"
#include "report/html_page.h"
#include "study/reproduce.h"

namespace cloth {

class ReproductionIndex {
 public:
  ResultFolder& folder() { return folder_; }

  /// Claims the folder. Where an unfinished reproduction goes on, page and result are as after its last part.
  std::optional<IoError> begin(const ReproduceOptions& options, HtmlPage& page, ReproduceResult& result);

  bool has(const std::string& part) const;

  /// The part is finished.
  std::optional<IoError> keep(const std::string& part, const HtmlPage& page, const ReproduceResult& result);

  /// After all other files. A stopped one keeps what it needs to go on.
  std::optional<IoError> end(const ReproduceResult& result);

 private:
  std::optional<IoError> look_at_earlier(const ReproduceOptions& options, HtmlPage& page,
                                         ReproduceResult& result);
  bool agree(const std::vector<FileDigest>& digests) const;

  ResultFolder folder_;
  nlohmann::ordered_json inputs_;  ///< what must be the same to go on
  nlohmann::ordered_json state_;   ///< what finished parts left: page, numbers, files
  std::vector<std::string> parts_;
};

}  // namespace cloth
