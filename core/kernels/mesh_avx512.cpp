#include "kernels/lanes_avx512.h"
//
#include "kernels/mesh_passes.h"

namespace cloth::kernels {

const MeshKernels& avx512_mesh_kernels() {
  return mesh_kernels;
}

}  // namespace cloth::kernels
