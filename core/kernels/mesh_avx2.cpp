#include "kernels/lanes_avx2.h"
//
#include "kernels/mesh_passes.h"

namespace cloth::kernels {

const MeshKernels& avx2_mesh_kernels() {
  return mesh_kernels;
}

}  // namespace cloth::kernels
