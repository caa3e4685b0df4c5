#include "kernels/lanes_sse2.h"
//
#include "kernels/mesh_passes.h"

namespace cloth::kernels {

const MeshKernels& sse2_mesh_kernels() {
  return mesh_kernels;
}

}  // namespace cloth::kernels
