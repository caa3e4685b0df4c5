// A kernel source, see kernel_table.h.
#include CLOTHLAB_LANES
//
#include "kernels/mesh_passes.h"

namespace cloth::kernels {

const MeshKernels& MeshKernels::CLOTHLAB_SET() {
  return mesh_kernels;
}

}  // namespace cloth::kernels
