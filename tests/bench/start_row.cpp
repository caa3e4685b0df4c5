#include "start_row.h"

#include <fmt/format.h>

#include <QApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <QOpenGLShaderProgram>
#include <QProcess>
#include <array>
#include <cstdio>
#include <cstring>

#include "bench_tools.h"
#include "main_window/lab_window.h"
#include "theme/theme.h"

namespace clothlab {
namespace {

using json = nlohmann::ordered_json;

constexpr const char* window_start = "--one-start-of-the-window";
constexpr const char* gl_start = "--one-start-of-opengl";
constexpr std::array stages{"main", "application", "window", "picture"};

int start_window(int argc, char** argv) {
  std::array<double, stages.size()> at{processor_time()};
  QApplication application(argc, argv);
  QSurfaceFormat::setDefaultFormat(ClothView::surface_format());
  apply_theme(application);
  at[1] = processor_time();
  open_first_window({});
  LabWindow& window = *LabWindow::all().front();
  at[2] = processor_time();
  QObject::connect(&window.view(), &ClothView::frameDrawn, &window, [&at] {
    QTimer::singleShot(0, [&at] {  // once it has been painted
      at[3] = processor_time();
      QApplication::quit();
    });
  });
  QApplication::exec();
  for (const double seconds : at) fmt::print("{} ", 1e3 * seconds);
  std::fflush(stdout);
  std::_Exit(0);  // what the end takes is another matter
}

/// A context, a shader, one triangle and its picture: what no view on this machine can do without.
int start_gl(int argc, char** argv) {
  QGuiApplication application(argc, argv);
  const double before = processor_time();
  QOpenGLContext context;
  context.setFormat(ClothView::surface_format());
  QOffscreenSurface surface;
  surface.setFormat(ClothView::surface_format());
  surface.create();
  if (context.create() && context.makeCurrent(&surface)) {
    QOpenGLFramebufferObject target(256, 256);
    target.bind();
    QOpenGLShaderProgram program;
    program.addShaderFromSourceCode(QOpenGLShader::Vertex,
                                    "#version 330\nvoid main() { gl_Position = "
                                    "vec4(gl_VertexID - 1, gl_VertexID % 2, 0, 1); }");
    program.addShaderFromSourceCode(QOpenGLShader::Fragment,
                                    "#version 330\nout vec4 c; void main() { c = vec4(1); }");
    program.link();
    program.bind();
    context.functions()->glDrawArrays(GL_TRIANGLES, 0, 3);
    target.toImage();
  }
  fmt::print("{} ", 1e3 * (processor_time() - before));
  std::fflush(stdout);
  std::_Exit(0);
}

/// What a new process prints, number by number.
std::vector<double> numbers_of(const char* kind) {
  QProcess process;
  process.start(QCoreApplication::applicationFilePath(), {QString::fromLatin1(kind)});
  process.waitForFinished(60000);
  std::vector<double> numbers;
  for (const QByteArray& word : process.readAllStandardOutput().split(' '))
    if (!word.isEmpty()) numbers.push_back(word.toDouble());
  return numbers;
}

}  // namespace

int one_start(int argc, char** argv) {
  if (argc != 2) return -1;
  if (std::strcmp(argv[1], window_start) == 0) return start_window(argc, argv);
  if (std::strcmp(argv[1], gl_start) == 0) return start_gl(argc, argv);
  return -1;
}

json start_row(int rounds) {
  std::array<std::vector<double>, stages.size()> at;
  std::vector<double> gl;
  for (int round = 0; round < rounds + 1; ++round) {  // the first one warms the caches of files
    const std::vector<double> window = numbers_of(window_start), alone = numbers_of(gl_start);
    if (round == 0 || window.size() != stages.size() || alone.size() != 1) continue;
    for (std::size_t s = 0; s < stages.size(); ++s) at[s].push_back(window[s]);
    gl.push_back(alone.front());
  }
  json row{{"rounds", gl.size()}};
  for (std::size_t s = 0; s < stages.size(); ++s) row["until_ms"][stages[s]] = median(at[s]);
  row["opengl_alone_ms"] = median(gl);
  return row;
}

void print_start_row(const json& row) {
  const json& until = row["until_ms"];
  fmt::print(
      "\nstart, processor time until main() {:.0f} ms, the application {:.0f} ms, the window {:.0f} ms, "
      "its first picture {:.0f} ms; OpenGL with one drawing alone {:.0f} ms (medians of {} starts)\n",
      until["main"].get<double>(), until["application"].get<double>(), until["window"].get<double>(),
      until["picture"].get<double>(), row["opengl_alone_ms"].get<double>(), row["rounds"].get<int>());
}

}  // namespace clothlab
