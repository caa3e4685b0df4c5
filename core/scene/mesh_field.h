// How a parameter that names a mesh is declared.
#pragma once

#include "params/parameter.h"
#include "scene/scene_mesh.h"

namespace cloth {

/// A mesh is chosen by its file; load_meshes() reads it.
template <class Owner>
Field<Owner> mesh_file(MeshChoice Owner::*member, ParameterInfo info) {
  info.kind = Kind::text;
  return {std::move(info), [member](const Owner& owner) { return ParameterValue((owner.*member).file); },
          [member](Owner& owner, const ParameterValue& value) {
            (owner.*member).file = std::get<std::string>(value);
          }};
}

}  // namespace cloth
