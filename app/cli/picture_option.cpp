#include "picture_option.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "io/user_file.h"
#include "picture/picture.h"

namespace clothlab::cli {
namespace {

constexpr int largest_picture = 8192;  // px, either way

/// Degrees: azimuth from the front to the right, elevation above the horizon.
struct View {
  double azimuth = 0, elevation = 0;

  cloth::Vec3 towards_eye() const {
    const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
  }
};

struct NamedView {
  const char* name;
  View view;
};
constexpr NamedView views[] = {{"front", {0, 0}},  {"back", {180, 0}}, {"left", {-90, 0}},
                               {"right", {90, 0}}, {"top", {0, 90}},   {"corner", {30, 23}}};

/// "12.5,-3" or "640x480" as two numbers; nothing where it is something else.
template <class Number>
std::optional<std::pair<Number, Number>> two_numbers(const std::string& text, char between) {
  std::pair<Number, Number> found;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, found.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != between) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, found.second);
  if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
  return found;
}

std::optional<View> view_of(const std::string& text) {
  for (const NamedView& named : views)
    if (text == named.name) return named.view;
  const auto angles = two_numbers<double>(text, ',');
  if (!angles || !(std::abs(angles->first) <= 360) || !(std::abs(angles->second) <= 90)) return std::nullopt;
  return View{angles->first, angles->second};
}

std::optional<std::pair<int, int>> size_of(const std::string& text) {
  const auto size = two_numbers<int>(text, 'x');
  const auto fits = [](int pixels) { return pixels >= 1 && pixels <= largest_picture; };
  if (!size || !fits(size->first) || !fits(size->second)) return std::nullopt;
  return size;
}

std::string wrong_view(const std::string& text) {
  if (view_of(text)) return "";
  return text +
         ": must be front, back, left, right, top, corner, or AZIMUTH,ELEVATION in degrees, from -360 to 360 "
         "and "
         "-90 to 90, as 30,20";
}

std::string wrong_size(const std::string& text) {
  if (size_of(text)) return "";
  return fmt::format("{}: must be WIDTHxHEIGHT in pixels, each from 1 to {}, as 1280x960", text,
                     largest_picture);
}

std::string wrong_theme(const std::string& text) {
  return text == "light" || text == "dark" ? "" : text + ": must be light or dark";
}

}  // namespace

void add_picture(CLI::App& command, PictureArguments& arguments) {
  CLI::Option* file = add_path(command, "--picture", arguments.file,
                               "PNG file for a picture of the cloth after the last step, with the obstacles");
  const auto add = [&](const char* option, std::string& value, const char* help,
                       std::string (*wrong)(const std::string&)) {
    command.add_option(option, value, help)
        ->capture_default_str()
        ->needs(file)
        ->check(CLI::Validator([wrong](const std::string& text) { return wrong(text); }, ""));
  };
  add("--view", arguments.view,
      "Where the picture is taken from: front, back, left, right, top, corner, or AZIMUTH,ELEVATION in "
      "degrees",
      wrong_view);
  add("--size", arguments.size, "Of the picture in pixels, WIDTHxHEIGHT", wrong_size);
  add("--theme", arguments.theme, "Of the picture, light or dark", wrong_theme);
}

std::optional<cloth::IoError> write_picture(const PictureArguments& arguments, const cloth::Scene& scene,
                                            const cloth::ClothSystem& system,
                                            const cloth::ClothState& state) {
  const auto [width, height] = *size_of(arguments.size);
  const cloth::PictureCamera camera =
      cloth::camera_showing(scene, state.position, view_of(arguments.view)->towards_eye(),
                            static_cast<double>(width) / height, {}, state.time);
  const auto bytes = cloth::cloth_picture(
      scene, system, state.position, camera,
      {.width = width,
       .height = height,
       .time = state.time,
       .theme = arguments.theme == "dark" ? &cloth::dark_picture() : &cloth::light_picture()});
  return cloth::write_user_file(arguments.file, {bytes.begin(), bytes.end()});
}

}  // namespace clothlab::cli
