#include "kernels/lanes_portable.h"
//
#include "kernels/mesh_passes.h"

namespace cloth::kernels {

const MeshKernels& portable_mesh_kernels() {
  return mesh_kernels;
}

}  // namespace cloth::kernels
