// A kernel source, see kernel_table.h.
#include CLOTHLAB_LANES
//
#include "kernels/coloured_descent.h"
#include "kernels/coloured_visits.h"
#include "kernels/element_visits.h"

namespace cloth::kernels {
namespace {

constexpr LocalKernels local_kernels{project_coloured, project_elements, descend_coloured,
                                     extrapolate_all,  field_to_vectors, field_from_vectors};

}  // namespace

const LocalKernels& LocalKernels::CLOTHLAB_SET() {
  return local_kernels;
}

}  // namespace cloth::kernels
