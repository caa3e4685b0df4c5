#include "scenes/scene_gallery.h"

#include <QCoreApplication>

#include "compare/builtin_comparisons.h"
#include "scene/builtin_scenes.h"

namespace clothlab {
namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("SceneGallery", text);
}

}  // namespace

std::vector<GalleryGroup> scene_gallery() {
  return {
      {tr("A first look"),
       {{"flag", tr("Waves run along the cloth and swell with each gust"), 2.6, "front"},
        {"tablecloth", tr("Folds form where the cloth hangs down at the corners"), 0.6},
        {"ball", tr("Contact with friction: folds, slides and comes to rest"), 0.6}}},
      {tr("Springs, damping and methods"),
       {{"corners-free", tr("Plain springs: change stiffness, damping or method"), 0.3},
        {"pendulum", tr("The smallest cloth: errors and orders are easy to see"), 0.2},
        {"free-fall", tr("Known in closed form: a check of gravity and method"), 0.3}}},
      {tr("Deformation rate: a limit on stretching"),
       {{"corners-structural", tr("Only threads are limited: diagonals still give way"), 1.0},
        {"corners-shear", tr("Diagonals are limited too: hangs like woven cloth"), 0.7}}},
      {tr("Wind"),
       {{"wind", tr("Each gust lifts the free edge again"), 0.3},
        {"curtain", tr("A wide cloth on many pins in slow gusts"), 0.25}}},
      {tr("Falling on obstacles"),
       {{"cube", tr("Straight edges, met particle by particle"), 0.6},
        {"rectangle", tr("Velocities are reflected; half of the cloth hangs beside the box"), 0.42, "left"},
        {"disc", tr("The cloth is a mesh instead of a grid"), 0.6},
        {"bunny", tr("The obstacle is a mesh with hollows and ears"), 0.6}}},
      {tr("Continuous contact: edges, spikes and speed"),
       {{"corner", tr("The corner does not come through between particles"), 0.7},
        {"spikes", tr("64 tips touch the cloth at once"), 0.5},
        {"slope", tr("Friction holds: the cloth must stay where it lies"), 0.5},
        {"fast-ball", tr("Extreme: centimetres in each step, and no contact is missed"), 0.026}}},
      {tr("Self-contact: a cloth on itself"),
       {{"fold", tr("Layer comes to lie on layer"), 0.6},
        {"twist", tr("Friction winds the cloth up into folds"), 2.0}}},
      {tr("Fabrics: materials in units of a laboratory"),
       {{"flag-cotton", tr("Broadcloth: hardly stretches, and bends as it was measured"), 2.6, "front"},
        {"tablecloth-denim", tr("Denim: few and wide folds, for it is stiff"), 1.0},
        {"cantilever-paper", tr("Bending alone carries it; the same on a finer grid"), 3.0},
        {"cusick-interlock", tr("The laboratory's test of drape: a round specimen on a disc"), 1.5},
        {"corners-target", tr("A tight weave: 4 kN/m along warp and weft, soft along the bias"), 1.0},
        {"wind-denim", tr("Each gust lifts even 324 grams a square metre"), 0.6},
        {"curtain-wool", tr("Light wool between its rings"), 0.6},
        {"ball-interlock", tr("A T-shirt's knit gives way by a fifth of its length"), 0.6},
        {"disc-interlock", tr("A material on a mesh: triangles of constant strain"), 0.6},
        {"cube-ribbon", tr("A stiff fabric stands off from the edges"), 0.6},
        {"rectangle-ponte", tr("Ponte knit, limp and heavy, slips past the box"), 0.42, "left"},
        {"bunny-knit", tr("Rib knit follows hollows and ears"), 0.6},
        {"corner-wool", tr("Wool over a corner, continuous contact"), 0.7},
        {"spikes-swim", tr("Swimwear stretches over 64 tips"), 0.5},
        {"slope-wool", tr("Friction holds it, whatever it is made of"), 0.5},
        {"fast-ball-denim", tr("The wave of a blow runs through denim at its own speed"), 0.014},
        {"fold-ribbon", tr("A stiff strip lays itself in wide loops"), 0.6},
        {"twist-ponte", tr("A knit is wound up and winds on itself"), 1.4}}},
      {tr("Methods side by side"),
       {{"report-methods", tr("Semi-implicit Euler, Verlet and Runge-Kutta 4, the same step"), 0.3},
        {"explicit-implicit", tr("Which stays stable, and what a long step costs in error"), 0.3}}},
  };
}

QString gallery_title(const QString& name) {
  if (const auto* scene = cloth::find_builtin_scene(name.toStdString()))
    return QString::fromStdString(scene->title);
  const auto* comparison = cloth::find_builtin_comparison(name.toStdString());
  return comparison ? QString::fromStdString(comparison->title) : name;
}

QString gallery_picture(const QString& name, bool dark) {
  return QStringLiteral(":/clothlab/gallery/%1/%2.jpg").arg(dark ? "dark" : "light", name);
}

}  // namespace clothlab
