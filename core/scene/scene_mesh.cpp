#include "scene/scene_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>

#include "geometry/builtin_meshes.h"
#include "geometry/mesh_repair.h"
#include "io/fnv_hash.h"
#include "io/obj_reader.h"
#include "scene/obstacle_shape.h"
#include "scene/scene.h"

namespace cloth {
namespace {

namespace fs = std::filesystem;

using SharedMesh = std::shared_ptr<const LoadedMesh>;

std::string hash_of(const TriangleMesh& mesh) {
  FnvHash hash;
  for (const Vec3& v : mesh.vertices) hash.add(std::span<const double>(v.data(), 3));
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t) hash.add(static_cast<std::uint64_t>(corner));
  return hash.text();
}

/// Vertices of no triangle would be particles that nothing holds. Returns how many there were.
std::size_t take_out_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const Triangle& t : mesh.triangles)
    for (const int corner : t) number[static_cast<std::size_t>(corner)] = 0;
  std::vector<Vec3> used;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(used.size());
    used.push_back(mesh.vertices[i]);
  }
  for (Triangle& t : mesh.triangles)
    for (int& corner : t) corner = number[static_cast<std::size_t>(corner)];
  mesh.vertices.swap(used);
  return used.size() - mesh.vertices.size();
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

void list_edges(LoadedMesh& mesh) {
  for (const MeshEdge& edge : unique_edges(mesh.surface)) {
    mesh.edges.push_back({edge.from, edge.to});
    if (edge.triangles == 1) ++mesh.open_edges;
    const auto [a, b] = std::minmax(edge.opposite[0], edge.opposite[1]);
    if (a >= 0 && a != b) mesh.hinges.push_back({a, b});
  }
  std::sort(mesh.hinges.begin(), mesh.hinges.end());
  mesh.hinges.erase(std::unique(mesh.hinges.begin(), mesh.hinges.end()), mesh.hinges.end());
}

SharedMesh prepared(const std::string& file, const TriangleMesh& from_file, bool built_in) {
  auto mesh = std::make_shared<LoadedMesh>();
  mesh->file = file;
  mesh->built_in = built_in;
  Weld welded = weld(from_file, 0);
  mesh->surface = std::move(welded.mesh);
  const std::size_t unused = take_out_unused_vertices(mesh->surface);
  const std::size_t removed = static_cast<std::size_t>(welded.merged_vertices) + unused;
  if (removed > 0 && !built_in)
    mesh->notices.push_back(counted(removed, "vertex is", "vertices are") +
                            " at the place of another or of no triangle, and left out; those after have "
                            "lower numbers than in the file");
  if (welded.collapsed_triangles > 0)
    mesh->notices.push_back(
        counted(static_cast<std::size_t>(welded.collapsed_triangles), "triangle has", "triangles have") +
        " two corners at one place, and left out");
  for (const MeshFinding& finding : inspect(mesh->surface))
    if (finding.fault != MeshFault::open_edge) mesh->notices.push_back(finding.message);
  list_edges(*mesh);
  for (const Vec3& vertex : mesh->surface.vertices) mesh->bounds.extend(vertex);
  mesh->hash = hash_of(mesh->surface);
  return mesh;
}

/// Made once: constant, and shared by all users.
SharedMesh built_in_mesh(const BuiltinMesh& which) {
  static std::mutex mutex;
  static std::map<std::string, SharedMesh> made;
  const std::lock_guard lock(mutex);
  SharedMesh& mesh = made[which.name];
  if (!mesh) mesh = prepared(which.name, which.make(), true);
  return mesh;
}

/// A file of the scene's folder, else a built-in mesh; or what is wrong with it.
struct Loading {
  SharedMesh mesh;
  std::string rule;
};

Loading load(const std::string& file, const SceneFolder& folder) {
  if (file.empty()) return {nullptr, "must name a mesh: an OBJ file, or a built-in one"};
  const BuiltinMesh* built_in = find_builtin_mesh(file);
  if (built_in && folder.built_in) return {built_in_mesh(*built_in), {}};
  const fs::path path = fs::path(folder.path) / file;
  std::error_code error;
  if (fs::is_regular_file(path, error)) {
    ObjReading reading = read_obj(path);
    if (!reading.mesh) return {nullptr, "cannot be used: " + reading.problem};
    SharedMesh mesh = prepared(file, *reading.mesh, false);
    if (mesh->surface.triangles.empty())
      return {nullptr, "cannot be used: all of its triangles are degenerate"};
    return {std::move(mesh), {}};
  }
  if (built_in) return {built_in_mesh(*built_in), {}};
  std::string names;
  for (const BuiltinMesh& known : builtin_meshes()) names += (names.empty() ? "" : ", ") + known.name;
  return {nullptr,
          fmt::format("must be a file, as seen from the scene's folder, or a built-in mesh: {}", names)};
}

/// Visits the scene's cloth and obstacles where they have a mesh.
template <class SceneType, class Visit>  // visit(path, choice)
void for_each_mesh(SceneType& scene, Visit visit) {
  if (scene.cloth.is_mesh()) visit(std::string("cloth.mesh"), scene.cloth.mesh);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    if (shape_of(scene.obstacles[i]).is_from_file)
      visit(fmt::format("obstacles.{}.file", i), scene.obstacles[i].mesh);
}

SharedMesh find_loaded(const Scene* scene, const SceneFolder& folder, const std::string& file) {
  SharedMesh found;
  if (scene && scene->folder.path == folder.path && scene->folder.built_in == folder.built_in)
    for_each_mesh(*scene, [&](const std::string&, const MeshChoice& mesh) {
      if (mesh.is_loaded() && mesh.file == file) found = mesh.loaded;
    });
  return found;
}

}  // namespace

MeshChoice made_mesh(const std::string& name, const TriangleMesh& surface) {
  return {name, prepared(name, surface, false)};
}

std::vector<Problem> load_meshes(Scene& scene, const Scene* known) {
  std::vector<Problem> problems;
  for_each_mesh(scene, [&](const std::string& path, MeshChoice& mesh) {
    if (mesh.is_loaded()) return;
    mesh.loaded = find_loaded(known, scene.folder, mesh.file);
    if (!mesh.loaded) mesh.loaded = find_loaded(&scene, scene.folder, mesh.file);
    if (mesh.loaded) return;
    Loading loading = load(mesh.file, scene.folder);
    mesh.loaded = std::move(loading.mesh);
    if (!mesh.loaded) problems.push_back({path, '"' + mesh.file + '"', loading.rule});
  });
  if (scene.cloth.is_mesh() && scene.cloth.mesh.is_loaded()) {
    scene.cloth.rows = 1;
    scene.cloth.columns = static_cast<int>(scene.cloth.mesh.loaded->surface.vertices.size());
  }
  return problems;
}

std::vector<std::string> mesh_notices(const Scene& scene) {
  std::vector<std::string> notices;
  for_each_mesh(scene, [&](const std::string& path, const MeshChoice& mesh) {
    if (!mesh.is_loaded()) return;
    const auto add = [&](const std::string& notice) {
      notices.push_back(fmt::format("{} = \"{}\": {}", path, mesh.file, notice));
    };
    for (const std::string& notice : mesh.loaded->notices) add(notice);
    if (&mesh != &scene.cloth.mesh && mesh.loaded->open_edges > 0)
      add(fmt::format("{} of its edges are open: it has a border, and no inside", mesh.loaded->open_edges));
  });
  return notices;
}

std::vector<std::string> mesh_files(const Scene& scene) {
  std::vector<std::string> files;
  for_each_mesh(scene, [&](const std::string&, const MeshChoice& mesh) {
    if (mesh.is_loaded() && !mesh.loaded->built_in)
      files.push_back((fs::path(scene.folder.path) / mesh.file).string());
  });
  return files;
}

Scene moved_to_folder(const Scene& scene, const std::string& folder) {
  Scene moved = scene;
  moved.folder = {folder};
  std::error_code error;
  // ".." leads up from where a link points to, not from where it lies.
  const auto whole = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::current_path(error) / path, error);
  };
  const fs::path from(scene.folder.path), to = whole(folder);
  const auto seen_from_there = [&](const std::string& name) {
    const fs::path file = from / name;
    const fs::path seen = (whole(file.parent_path()) / file.filename()).lexically_relative(to);
    return (seen.empty() ? file : seen).generic_string();
  };
  if (moved.measured && !moved.measured->file.empty() && !fs::path(moved.measured->file).is_absolute())
    moved.measured->file = seen_from_there(moved.measured->file);
  for_each_mesh(moved, [&](const std::string&, MeshChoice& mesh) {
    if (!mesh.is_loaded() || mesh.loaded->built_in || fs::path(mesh.file).is_absolute()) return;
    auto renamed = std::make_shared<LoadedMesh>(*mesh.loaded);
    mesh.file = renamed->file = seen_from_there(mesh.file);
    mesh.loaded = std::move(renamed);
  });
  return moved;
}

}  // namespace cloth
