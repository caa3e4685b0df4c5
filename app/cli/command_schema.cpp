#include "commands.h"
#include "console.h"
#include "scene/reference_page.h"
#include "scene/scene_json.h"

namespace clothlab::cli {

int schema() {
  return print(cloth::scene_schema());
}

int parameters() {
  return print(cloth::reference_page());
}

}  // namespace clothlab::cli
