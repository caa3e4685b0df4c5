// The declared parameters of the blocks whose parameters are the same in every scene.
#pragma once

#include "scene/scene.h"

namespace cloth {

Fields<SpringMaterial> spring_fields();
Fields<Material> material_fields();
Fields<Gust> gust_fields();
Fields<Air> air_fields();
Fields<Deformation> deformation_fields();
Fields<ContactSettings> contact_fields();
Fields<SelfContact> self_contact_fields();
Field<Scene> damping_field();

/// What the Add menu fills in: a medium cotton weave.
Material starter_material();

}  // namespace cloth
