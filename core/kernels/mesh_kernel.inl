// The loops of mesh_kernel.h over the type Lanes, which the including file defines for its
// instruction set together with
//
//   lanes                                  doubles in a Lanes
//   load_lanes(from), store_lanes(to, a)   of contiguous doubles, aligned or not
//   scale_of(dx, dy, dz, k, kL)            k - kL/|d|; finite where |d| = 0
//   gather(from, at, x, y, z)              x y z of the 4-vectors at from + at(0) ... from + at(lanes - 1)
//   for_each_vector(at, x, y, z, visit)    the way back: visit(at(l), vector l), l = 0, 1, ...
//   add_to(to, vector), put(to, vector)    to a 4-vector in memory
//
// Everything here has internal linkage. Nothing may be included from it.

constexpr int parts = slice_width / lanes;

/// The 4-vectors of a slice, one after the other.
struct From {
  int first;
  int operator()(int lane) const { return 4 * (first + lane); }
};
struct Listed {
  const int* offset;
  int operator()(int lane) const { return offset[lane]; }
};

void load(const double* x, const double* y, const double* z, int begin, int end, const MeshArrays& to) {
  const Lanes zero{};
  int i = begin;
  for (; i + lanes <= end; i += lanes) {
    for_each_vector(From{i}, load_lanes(x + i), load_lanes(y + i), load_lanes(z + i),
                    [&](int at, auto vector) { put(to.position + at, vector); });
    for (int k = 0; k < 4; ++k) store_lanes(to.force + 4 * i + k * lanes, zero);
  }
  for (; i < end; ++i) {
    double *p = to.position + 4 * i, *f = to.force + 4 * i;
    p[0] = x[i], p[1] = y[i], p[2] = z[i], p[3] = 0;
    f[0] = f[1] = f[2] = f[3] = 0;
  }
}

void store(const MeshArrays& from, int begin, int end, double* fx, double* fy, double* fz) {
  int i = begin;
  for (; i + lanes <= end; i += lanes) {
    Lanes x, y, z;
    gather(from.force, From{i}, x, y, z);
    store_lanes(fx + i, load_lanes(fx + i) + x);
    store_lanes(fy + i, load_lanes(fy + i) + y);
    store_lanes(fz + i, load_lanes(fz + i) + z);
  }
  for (; i < end; ++i) {
    const double* f = from.force + 4 * i;
    fx[i] += f[0], fy[i] += f[1], fz[i] += f[2];
  }
}

// Legend: i the particle of a lane, j its neighbour; d = x_i - x_j; k, L stiffness and rest
// length; f the sum on i.
void add_springs(const MeshArrays& mesh, int begin, int end) {
  // Nothing that the loop stores changes what it reads, except the forces: the compiler cannot know.
  const int *__restrict slot_begin = mesh.slot_begin, *__restrict neighbour = mesh.neighbour;
  const double *__restrict stiffness = mesh.stiffness, *__restrict tension = mesh.tension;
  const double* __restrict position = mesh.position;
  double* __restrict force = mesh.force;
  const auto add = [force](int at, auto vector) { add_to(force + at, vector); };
  for (int slice = begin; slice < end; ++slice) {
    const int first = slice * slice_width;
    Lanes xi[parts], yi[parts], zi[parts], fx[parts], fy[parts], fz[parts];
    for (int p = 0; p < parts; ++p) {
      gather(position, From{first + p * lanes}, xi[p], yi[p], zi[p]);
      fx[p] = fy[p] = fz[p] = Lanes{};
    }
    for (int slot = slot_begin[slice]; slot < slot_begin[slice + 1]; ++slot)
      for (int p = 0; p < parts; ++p) {
        const int at = slot * slice_width + p * lanes;
        const Listed j{neighbour + at};
        Lanes x, y, z;
        gather(position, j, x, y, z);
        const Lanes dx = xi[p] - x, dy = yi[p] - y, dz = zi[p] - z;
        const Lanes scale = scale_of(dx, dy, dz, load_lanes(stiffness + at), load_lanes(tension + at));
        const Lanes gx = scale * dx, gy = scale * dy, gz = scale * dz;
        fx[p] -= gx, fy[p] -= gy, fz[p] -= gz;
        for_each_vector(j, gx, gy, gz, add);
      }
    for (int p = 0; p < parts; ++p) for_each_vector(From{first + p * lanes}, fx[p], fy[p], fz[p], add);
  }
}

void sweep(const MeshArrays& mesh, MeshSweep& through, int begin, int end) {
  for (int slice = begin; slice < end; ++slice) {
    const int load_until = through.load_until[slice], store_until = through.store_until[slice];
    if (through.loaded < load_until) {
      load(through.x, through.y, through.z, through.loaded, load_until, mesh);
      through.loaded = load_until;
    }
    add_springs(mesh, slice, slice + 1);
    if (through.stored < store_until) {
      store(mesh, through.stored, store_until, through.fx, through.fy, through.fz);
      through.stored = store_until;
    }
  }
}
