#include "commands.h"
#include "compare/comparison_json.h"
#include "console.h"
#include "scene/reference_page.h"
#include "scene/scene_json.h"

namespace clothlab::cli {

int schema(bool of_comparison) {
  return print(of_comparison ? cloth::comparison_schema() : cloth::scene_schema());
}

int parameters() {
  return print(cloth::reference_page());
}

}  // namespace clothlab::cli
