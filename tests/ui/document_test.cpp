// LabDocument: every edit can be undone, a refused one changes nothing, and each change is announced once.
#include <QSignalSpy>
#include <QtTest>
#include <algorithm>
#include <limits>

#include "document/lab_document.h"
#include "listed_test.h"

namespace clothlab::test::document_test {

using cloth::NamedPin;
using cloth::Pin;
using cloth::PinnedParticle;
using cloth::Vec3;
using Effect = SceneChange::Effect;

namespace {

cloth::Scene hung_cloth() {
  cloth::Scene scene;
  scene.title = "Hung";
  scene.cloth.columns = 5;
  scene.cloth.rows = 4;
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = cloth::SpringMaterial{.structural = 500, .shear = 250, .flexion = 50, .damping = 0};
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

/// What a listener that keeps up with the signals has heard.
struct Ear : QObject {
  explicit Ear(LabDocument& document) {
    connect(&document, &LabDocument::parameterChanged, this,
            [this](const std::string& p) { parameters.push_back(p); });
    connect(&document, &LabDocument::blocksChanged, this, [this] { ++blocks; });
    connect(&document, &LabDocument::loaded, this, [this] { ++loads; });
    connect(&document, &LabDocument::sceneChanged, this,
            [this](const SceneChange& c) { changes.push_back(c); });
  }
  std::vector<std::string> parameters;
  std::vector<SceneChange> changes;
  int blocks = 0, loads = 0;
};

}  // namespace

class DocumentTest : public QObject {
  Q_OBJECT

 private:
  LabDocument* document_ = nullptr;
  LabDocument& doc() { return *document_; }
  void load_pins(const std::vector<Pin>& pins) {
    cloth::Scene scene = hung_cloth();
    scene.cloth.pins = pins;
    doc().load(scene);
  }

 private Q_SLOTS:
  void init() {
    document_ = new LabDocument;
    doc().load(hung_cloth(), "/somewhere/hung.scene.json");
  }
  void cleanup() { delete document_; }

  void an_edit_changes_the_value_and_says_so_once() {
    Ear ear(doc());
    QCOMPARE(doc().setParameter("springs.structural", 800.0), QString());
    QCOMPARE(doc().scene().springs->structural, 800.0);
    QCOMPARE(ear.parameters, std::vector<std::string>{"springs.structural"});
    QCOMPARE(ear.changes.size(), std::size_t(1));
    QCOMPARE(ear.changes[0].path, std::string("springs.structural"));
    QCOMPARE(ear.changes[0].effect, Effect::live);
    QCOMPARE(ear.blocks, 0);
    QCOMPARE(doc().undoStack().undoText(), QString("Change structural stiffness"));
  }

  void an_edit_that_costs_a_restart_says_so_also_when_undone() {
    Ear ear(doc());
    doc().setParameter("cloth.rows", std::int64_t{6});
    doc().undoStack().undo();
    QCOMPARE(ear.changes.size(), std::size_t(2));
    for (const SceneChange& change : ear.changes) QCOMPARE(change.effect, Effect::restart);
  }

  void a_refused_value_changes_nothing_and_says_the_rule() {
    Ear ear(doc());
    const cloth::Scene before = doc().scene();
    QCOMPARE(doc().setParameter("springs.structural", -3.0), QString("must be >= 0"));
    QCOMPARE(doc().setParameter("cloth.mass", 0.0), QString("must be > 0"));
    QVERIFY(!doc().setParameter("springs.shear", std::numeric_limits<double>::quiet_NaN()).isEmpty());
    QVERIFY(!doc().setParameter("springs.shear", std::numeric_limits<double>::infinity()).isEmpty());
    QVERIFY(!doc().setParameter("integrator.method", std::string("euler-ish")).isEmpty());
    QVERIFY(!doc().setParameter("cloth.down", Vec3(0, 0, 0)).isEmpty());
    QVERIFY(doc().scene() == before);
    QCOMPARE(doc().undoStack().count(), 0);
    QVERIFY(ear.changes.empty() && ear.parameters.empty());
  }

  void a_value_of_another_type_or_place_is_refused() {
    const cloth::Scene before = doc().scene();
    QVERIFY(!doc().setParameter("cloth.rows", 3.0).isEmpty());
    QVERIFY(!doc().setParameter("springs.shear", std::string("auto")).isEmpty());
    QVERIFY(!doc().setParameter("gravity", 9.81).isEmpty());
    QVERIFY(!doc().setParameter("air.drag", 0.1).isEmpty());
    QVERIFY(doc().scene() == before);
  }

  void an_equal_value_is_no_edit() {
    doc().setParameter("springs.structural", 500.0);
    QCOMPARE(doc().undoStack().count(), 0);
    QVERIFY(!doc().isModified());
  }

  void auto_is_a_value_of_the_time_step() {
    doc().setParameter("integrator.time_step", 0.002);
    QCOMPARE(doc().scene().integrator.time_step, std::optional<double>(0.002));
    QCOMPARE(doc().setParameter("integrator.time_step", std::string("auto")), QString());
    QVERIFY(!doc().scene().integrator.time_step);
  }

  void undo_then_redo_gives_the_same_scene() {
    std::vector<cloth::Scene> scenes{doc().scene()};
    const auto done = [&] { scenes.push_back(doc().scene()); };
    doc().setParameter("springs.shear", 1.0 / 3), done();
    doc().addBlock("air"), done();
    doc().setParameter("air.wind", Vec3(1, 2, 3)), done();
    doc().addBlock("sphere"), done();
    doc().addBlock("box"), done();
    doc().togglePin(0, 2), done();
    doc().removeBlock("obstacles.0"), done();
    doc().setParameter("cloth.rows", std::int64_t{9}), done();
    doc().removeBlock("springs"), done();
    doc().togglePin(1, 1), done();
    QCOMPARE(doc().undoStack().count(), 10);
    for (int round = 0; round < 2; ++round) {
      for (std::size_t i = scenes.size() - 1; i-- > 0;) {
        doc().undoStack().undo();
        QVERIFY(doc().scene() == scenes[i]);
      }
      for (std::size_t i = 1; i < scenes.size(); ++i) {
        doc().undoStack().redo();
        QVERIFY(doc().scene() == scenes[i]);
      }
    }
  }

  void a_drag_is_one_step_and_two_drags_are_two() {
    for (const double goal : {700.0, 900.0}) {
      doc().beginDrag();
      for (int i = 0; i <= 50; ++i) doc().setParameter("springs.structural", goal - 50 + i);
      doc().endDrag();
    }
    QCOMPARE(doc().undoStack().count(), 2);
    doc().undoStack().undo();
    QCOMPARE(doc().scene().springs->structural, 700.0);
    doc().undoStack().undo();
    QCOMPARE(doc().scene().springs->structural, 500.0);
  }

  void typed_values_are_separate_steps() {
    doc().setParameter("springs.structural", 600.0);
    doc().setParameter("springs.structural", 700.0);
    QCOMPARE(doc().undoStack().count(), 2);
  }

  void a_drag_that_comes_back_is_no_step() {
    doc().beginDrag();
    doc().setParameter("springs.structural", 600.0);
    doc().setParameter("springs.structural", 500.0);
    QCOMPARE(doc().undoStack().count(), 0);
    QVERIFY(!doc().isModified());
    doc().setParameter("springs.structural", 700.0);
    doc().endDrag();
    QCOMPARE(doc().undoStack().count(), 1);
    doc().undoStack().undo();
    QCOMPARE(doc().scene().springs->structural, 500.0);
  }

  void a_drag_over_a_save_keeps_both_steps() {
    doc().beginDrag();
    doc().setParameter("springs.structural", 600.0);
    doc().markSaved("/somewhere/else.scene.json");
    doc().setParameter("springs.structural", 700.0);
    doc().endDrag();
    QVERIFY(doc().isModified());
    doc().undoStack().undo();
    QCOMPARE(doc().scene().springs->structural, 600.0);
    QVERIFY(!doc().isModified());
  }

  void pins_that_a_drag_loses_on_the_way_come_back() {
    load_pins({PinnedParticle{3, 4}, NamedPin::top_left});
    const auto pins = doc().scene().cloth.pins;
    doc().beginDrag();
    doc().setParameter("cloth.rows", std::int64_t{3});
    QCOMPARE(doc().scene().cloth.pins.size(), std::size_t(1));
    doc().setParameter("cloth.rows", std::int64_t{7});
    doc().endDrag();
    QVERIFY(doc().scene().cloth.pins == pins);
  }

  void a_block_comes_and_goes_with_undo() {
    Ear ear(doc());
    QVERIFY(!doc().addBlock("springs"));
    QVERIFY(doc().addBlock("air"));
    QCOMPARE(doc().undoStack().undoText(), QString("Add air and wind"));
    QVERIFY(doc().scene().air.has_value());
    QCOMPARE(ear.blocks, 1);
    QCOMPARE(ear.changes.back().path, std::string("air"));
    QCOMPARE(ear.changes.back().effect, Effect::live);
    QVERIFY(doc().removeBlock("air"));
    QVERIFY(!doc().scene().air);
    doc().undoStack().undo();
    QVERIFY(doc().scene().air.has_value());
    QCOMPARE(ear.blocks, 3);
    QVERIFY(!doc().removeBlock("cloth"));
    QVERIFY(!doc().removeBlock("obstacles.0"));
  }

  void an_added_obstacle_is_announced_by_its_place() {
    Ear ear(doc());
    doc().addBlock("sphere");
    doc().addBlock("box");
    QCOMPARE(ear.changes.back().path, std::string("obstacles.1"));
  }

  void toggling_a_pin_of_an_edge_keeps_the_others() {
    Ear ear(doc());
    doc().togglePin(0, 2);
    QCOMPARE(pinned_particles(doc().scene().cloth), (std::vector<int>{0, 1, 3, 4}));
    QCOMPARE(ear.changes.size(), std::size_t(1));
    QCOMPARE(ear.changes.back().path, std::string("cloth.pins"));
    doc().togglePin(0, 2);
    QCOMPARE(pinned_particles(doc().scene().cloth), (std::vector<int>{0, 1, 2, 3, 4}));
    doc().undoStack().undo();
    doc().undoStack().undo();
    QVERIFY(doc().scene().cloth.pins == std::vector<Pin>{NamedPin::top_edge});
  }

  void a_particle_that_two_edges_hold_is_free_after_one_toggle() {
    load_pins({NamedPin::top_edge, NamedPin::left_edge, NamedPin::top_left});
    doc().togglePin(0, 0);
    QCOMPARE(pinned_particles(doc().scene().cloth), (std::vector<int>{1, 2, 3, 4, 5, 10, 15}));
  }

  void toggling_twice_gives_the_same_pins() {
    load_pins({NamedPin::top_left, PinnedParticle{2, 2}});
    const auto pins = doc().scene().cloth.pins;
    for (const auto& [row, column] : {std::pair(1, 1), std::pair(3, 4), std::pair(2, 2)}) {
      doc().togglePin(row, column);
      QVERIFY(doc().scene().cloth.pins != pins);
      doc().togglePin(row, column);
      QVERIFY(doc().scene().cloth.pins == pins);
    }
  }

  void a_particle_outside_the_grid_cannot_be_pinned() {
    doc().togglePin(4, 0);
    doc().togglePin(0, -1);
    QCOMPARE(doc().undoStack().count(), 0);
  }

  void reset_returns_the_declared_default() {
    doc().setParameter("springs.structural", 12.0);
    QCOMPARE(doc().resetParameter("springs.structural"), QString());
    QVERIFY(*doc().value("springs.structural") == *cloth::default_of(doc().scene(), "springs.structural"));
    QCOMPARE(doc().undoStack().undoText(), QString("Reset structural stiffness"));
    doc().undoStack().undo();
    QCOMPARE(doc().scene().springs->structural, 12.0);
  }

  void loading_forgets_the_history_and_is_announced_as_such() {
    doc().setParameter("springs.structural", 1.0);
    Ear ear(doc());
    QSignalSpy modified(&doc(), &LabDocument::modifiedChanged);
    doc().load(cloth::Scene{}, "/tmp/free-fall.scene.json");
    QCOMPARE(ear.loads, 1);
    QVERIFY(ear.changes.empty());
    QCOMPARE(doc().undoStack().count(), 0);
    QVERIFY(!doc().isModified());
    QCOMPARE(modified.count(), 1);
    QCOMPARE(doc().title(), QString("free-fall"));
  }

  void a_mesh_is_read_when_its_file_is_named_and_undone_with_it() {
    QVERIFY(doc().addBlock("mesh"));
    const auto loaded = [this] { return doc().scene().obstacles.at(0).mesh; };
    QVERIFY(loaded().is_loaded());
    QCOMPARE(doc().setParameter("obstacles.0.file", std::string("cone-bed.obj")), QString());
    QVERIFY(loaded().is_loaded());
    QCOMPARE(loaded().file, std::string("cone-bed.obj"));
    doc().undoStack().undo();
    QVERIFY(loaded().is_loaded());
    QCOMPARE(loaded().file, std::string("bunny.obj"));
  }

  void a_mesh_that_cannot_be_read_is_refused_and_changes_nothing() {
    QVERIFY(doc().addBlock("mesh"));
    const cloth::Scene before = doc().scene();
    QVERIFY(doc().setParameter("obstacles.0.file", std::string("none.obj")).contains("must be a file"));
    QVERIFY(doc().scene() == before);
  }

  void vertices_of_a_mesh_are_pinned_by_their_numbers() {
    cloth::Scene scene = hung_cloth();
    scene.cloth.mesh.file = "disc.obj";
    scene.cloth.pins.clear();
    QVERIFY(load_meshes(scene).empty());
    doc().load(scene, {});
    doc().togglePin(0, 1800);
    QCOMPARE(doc().scene().cloth.pins, std::vector<Pin>{(PinnedParticle{0, 1800})});
    doc().togglePin(0, 1800);
    QVERIFY(doc().scene().cloth.pins.empty());
  }

  void modified_follows_undo_and_save() {
    doc().setParameter("springs.structural", 1.0);
    QVERIFY(doc().isModified());
    doc().undoStack().undo();
    QVERIFY(!doc().isModified());
    doc().undoStack().redo();
    doc().markSaved("/tmp/x.scene.json");
    QVERIFY(!doc().isModified());
    QCOMPARE(doc().path(), QString("/tmp/x.scene.json"));
  }

  void every_parameter_of_every_block_can_be_set_to_what_it_is() {
    for (const char* offer : {"air", "air.gust", "deformation", "damping", "sphere", "box", "plane", "mesh"})
      QVERIFY(doc().addBlock(offer));
    const int steps = doc().undoStack().count();
    for (const cloth::Parameter& parameter : parameters_of(doc().scene()))
      QCOMPARE(doc().setParameter(parameter.path, parameter.get(doc().scene())), QString());
    QCOMPARE(doc().undoStack().count(), steps);
  }
};

const Listed listed{"document_test", test_main<DocumentTest>};

}  // namespace clothlab::test::document_test

#include "document_test.moc"
