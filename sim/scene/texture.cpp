#include "sim/scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <ranges>
#include <stdexcept>

namespace lcs::sim {
namespace {

using Colour = cv::Vec3b;

/// Drawing operations for styles, in whole pixels and grey levels, from one random stream.
class Brush {
 public:
  Brush(cv::Mat3b& picture, RandomStream random) : picture_(picture), random_(random) {}

  int width() const { return picture_.cols; }
  int height() const { return picture_.rows; }

  /// Uniform in [low, high).
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }

  /// A grey, with each channel tinted by up to `tint` grey levels.
  Colour grey(double low, double high, double tint) {
    const double value = between(low, high);
    Colour c;
    for (int i = 0; i < 3; ++i) c[i] = cv::saturate_cast<uchar>(value + between(-tint, tint));
    return c;
  }

  Colour& at(int y, int x) { return picture_(y, x); }

  void fill(const Colour& c) { picture_.setTo(c); }

  /// Corners as fractions of the image's sides.
  void rectangle(double left, double top, double right, double bottom, const Colour& c) {
    const cv::Point a(px(left, width()), px(top, height()));
    const cv::Point b(px(right, width()) - 1, px(bottom, height()) - 1);
    if (a.x <= b.x && a.y <= b.y) cv::rectangle(picture_, a, b, c, cv::FILLED);
  }

  /// A rectangle with sides in the given range, entirely within the margins.
  void rectangle_anywhere(double least, double most, double margin, const Colour& c) {
    const double w = between(least, most);
    const double h = between(least, most);
    const double x = between(margin, 1 - margin - w);
    const double y = between(margin, 1 - margin - h);
    rectangle(x, y, x + w, y + h, c);
  }

  void polygon(double cx, double cy, double radius, int corners, const Colour& c) {
    const double turn = between(0, 2 * CV_PI);
    std::vector<cv::Point> points;
    for (int i = 0; i < corners; ++i) {
      const double a = turn + 2 * CV_PI * i / corners;
      points.emplace_back(px(cx + radius * std::cos(a), width()),
                          px(cy + radius * std::sin(a), height()));
    }
    cv::fillConvexPoly(picture_, points, c, cv::LINE_AA);
  }

 private:
  static int px(double share, int side) { return static_cast<int>(std::lround(share * side)); }

  cv::Mat3b& picture_;
  RandomStream random_;
};

/// A light face with four dark patches, one per quarter, without contact.
void paint_fewrects(Brush& b) {
  b.fill(b.grey(150, 185, 8));
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double w = b.between(0.18, 0.32);
    const double h = b.between(0.18, 0.32);
    const int column = quarter % 2, row = quarter / 2;
    const double x = column * 0.46 + b.between(0.08, 0.44 - w);
    const double y = row * 0.46 + b.between(0.08, 0.44 - h);
    b.rectangle(x, y, x + w, y + h, b.grey(25, 80, 12));
  }
}

/// Cartons and cabinets: a light face with one dark patch.
void paint_panel(Brush& b) {
  b.fill(b.grey(150, 180, 6));
  const double left = b.between(0.15, 0.3);
  const double top = b.between(0.15, 0.3);
  b.rectangle(left, top, b.between(0.7, 0.85), b.between(0.5, 0.8), b.grey(40, 75, 8));
}

/// Sheet metal: light, with a smooth change of shade.
void paint_metal(Brush& b) {
  const double base = b.between(185, 200);
  for (int y = 0; y < b.height(); ++y) {
    const double v = base + 12 * std::cos(CV_PI * (y + 0.5) / b.height());
    for (int x = 0; x < b.width(); ++x) b.at(y, x) = Colour::all(cv::saturate_cast<uchar>(v));
  }
}

void paint_rects(Brush& b) {
  b.fill(b.grey(110, 130, 8));
  for (int i = 0; i < 40; ++i) {
    const Colour c = i % 2 ? b.grey(20, 70, 20) : b.grey(170, 230, 20);
    b.rectangle_anywhere(0.06, 0.2, 0, c);
  }
}

void paint_polygons(Brush& b) {
  b.fill(b.grey(120, 150, 10));
  for (int i = 0; i < 24; ++i) {
    const int corners = 3 + i % 3;
    const Colour c = i % 2 ? b.grey(20, 80, 25) : b.grey(180, 235, 15);
    const double x = b.between(0.1, 0.9);
    const double y = b.between(0.1, 0.9);
    b.polygon(x, y, b.between(0.06, 0.14), corners, c);
  }
}

/// A house front: rows of dark windows with a light bar; tiles seamlessly.
void paint_windows(Brush& b) {
  b.fill(b.grey(165, 195, 12));
  constexpr int kAcross = 4;
  constexpr int kUp = 4;
  for (int row = 0; row < kUp; ++row) {
    for (int column = 0; column < kAcross; ++column) {
      const double w = 1.0 / kAcross;
      const double h = 1.0 / kUp;
      const double x = column * w + 0.22 * w;
      const double y = row * h + 0.18 * h;
      const Colour pane = b.grey(25, 80, 12);
      b.rectangle(x, y, x + 0.56 * w, y + 0.62 * h, pane);
      b.rectangle(x + 0.26 * w, y, x + 0.30 * w, y + 0.62 * h, b.grey(200, 215, 5));
    }
  }
}

void paint_bricks(Brush& b) {
  b.fill(b.grey(165, 180, 5));
  constexpr int kAcross = 4;
  constexpr int kUp = 8;
  constexpr double kJoint = 0.012;
  for (int row = 0; row < kUp; ++row) {
    const double shift = row % 2 ? 0.5 / kAcross : 0;
    for (int column = -1; column < kAcross; ++column) {
      const double x = column / double(kAcross) + shift;
      const double v = b.between(70, 120);
      const Colour c = cv::Vec3d(v * 1.25, v * 0.8, v * 0.7);
      b.rectangle(std::max(0.0, x + kJoint), row / double(kUp) + kJoint, x + 1.0 / kAcross - kJoint,
                  (row + 1.0) / kUp - kJoint, c);
    }
  }
}

/// A painting in a light mount: dark land under a dark sky, two houses with a roof, a door and
/// windows, a tree, a sun.
void paint_picture(Brush& b) {
  constexpr double kMount = 0.09;
  b.fill(b.grey(205, 225, 6));
  const double horizon = b.between(0.5, 0.6);
  b.rectangle(kMount, kMount, 1 - kMount, 1 - kMount, b.grey(70, 85, 12));
  b.rectangle(kMount, horizon, 1 - kMount, 1 - kMount, b.grey(95, 110, 15));
  const double sun = b.between(0.05, 0.07);
  const double sun_x = b.between(0.4, 0.6);
  b.rectangle(sun_x - sun, 0.18 - sun, sun_x + sun, 0.18 + sun, b.grey(200, 225, 18));
  const double foot = b.between(0.8, 0.84);
  for (const double left : {b.between(0.16, 0.2), b.between(0.56, 0.6)}) {
    const double width = b.between(0.24, 0.28);
    const double eaves = b.between(0.4, 0.5);
    b.polygon(left + width / 2, eaves, 0.62 * width, 4, b.grey(140, 165, 18));
    b.rectangle(left, eaves, left + width, foot, b.grey(175, 205, 12));
    const double pane = 0.25 * width;
    const Colour dark = b.grey(25, 55, 12);
    b.rectangle(left + 0.15 * width, eaves + 0.06, left + 0.15 * width + pane, eaves + 0.15, dark);
    b.rectangle(left + 0.6 * width, eaves + 0.06, left + 0.6 * width + pane, eaves + 0.15, dark);
    b.rectangle(left + 0.36 * width, foot - 0.13, left + 0.64 * width, foot, dark);
  }
}

/// Corrugated board: printed marks towards its corners, tape over its middle, a label with lines.
void paint_carton(Brush& b) {
  b.fill(b.grey(165, 185, 5));
  const Colour print = b.grey(45, 75, 8);
  for (const double x : {0.05, 0.83}) {
    for (const double y : {0.05, 0.83}) {
      const double w = b.between(0.08, 0.12);
      const double h = b.between(0.08, 0.12);
      b.rectangle(x, y, x + w, y + h, print);
    }
  }
  const Colour tape = b.grey(105, 125, 6);
  b.rectangle(0.44, 0, 0.56, b.between(0.2, 0.26), tape);
  b.rectangle(0.44, b.between(0.76, 0.82), 0.56, 1, tape);
  const double left = b.between(0.12, 0.22);
  const double right = left + b.between(0.34, 0.4);
  const double top = b.between(0.34, 0.42);
  const double bottom = top + b.between(0.28, 0.32);
  b.rectangle(left, top, right, bottom, b.grey(225, 240, 4));
  b.rectangle(left + 0.05, top + 0.05, right - 0.05, top + 0.11, print);
  b.rectangle(left + 0.05, bottom - 0.11, left + 0.18, bottom - 0.04, print);
  const double sign = b.between(0.07, 0.09);
  b.polygon(b.between(0.72, 0.8), b.between(0.45, 0.55), sign, 3, print);
}

/// Boards of different shades in a frame of darker ones, each with its nails.
void paint_crate(Brush& b) {
  constexpr int kBoards = 4;
  constexpr double kFrame = 0.11;
  constexpr double kGap = 0.025;
  const Colour gap = b.grey(25, 45, 6);
  const Colour nail = b.grey(30, 50, 6);
  b.fill(gap);
  for (int board = 0; board < kBoards; ++board) {
    const double height = (1 - 2 * kFrame) / kBoards;
    const double top = kFrame + board * height;
    b.rectangle(kFrame, top + kGap, 1 - kFrame, top + height - kGap, b.grey(125, 195, 8));
  }
  const Colour frame = b.grey(150, 170, 8);
  for (const double x : {0.0, 1 - kFrame}) b.rectangle(x, 0, x + kFrame, 1, frame);
  for (const double y : {0.0, 1 - kFrame}) b.rectangle(kFrame, y, 1 - kFrame, y + kFrame, frame);
  for (const double x : {0.03, 0.92}) {
    for (const double y : {0.04, 0.9}) b.rectangle(x, y, x + 0.05, y + 0.06, nail);
  }
}

/// Drawers, each with a handle and a label, over a dark foot.
void paint_cabinet(Brush& b) {
  constexpr int kDrawers = 4;
  constexpr double kSide = 0.05;
  constexpr double kFoot = 0.06;
  b.fill(b.grey(70, 90, 5));
  b.rectangle(0, 1 - kFoot, 1, 1, b.grey(25, 35, 3));
  for (int drawer = 0; drawer < kDrawers; ++drawer) {
    const double height = (1 - kFoot) / kDrawers;
    const double top = drawer * height + 0.02;
    const double bottom = (drawer + 1) * height - 0.02;
    b.rectangle(kSide, top, 1 - kSide, bottom, b.grey(150, 185, 6));
    const double handle = b.between(0.55, 0.62);
    b.rectangle(handle, top + 0.06, handle + b.between(0.18, 0.24), top + 0.1, b.grey(30, 50, 4));
    const double label = b.between(0.14, 0.2);
    b.rectangle(label, top + 0.05, label + 0.2, top + 0.14, b.grey(225, 240, 3));
  }
}

/// A block of stone: a sunken field with a plate, mouldings above and below.
void paint_plinth(Brush& b) {
  b.fill(b.grey(150, 170, 4));
  b.rectangle(0.1, 0.14, 0.9, 0.86, b.grey(95, 110, 4));
  const double top = b.between(0.26, 0.34);
  b.rectangle(0.24, top, 0.76, top + b.between(0.2, 0.26), b.grey(200, 220, 8));
  b.rectangle(0.34, top + 0.07, 0.66, top + 0.12, b.grey(40, 60, 4));
  for (const double x : {0.18, 0.42, 0.66}) b.rectangle(x, 0.68, x + 0.14, 0.78, b.grey(45, 70, 5));
}

/// Carved and inlaid stone: rows of dark lozenges and triangles on a light ground, a band below.
void paint_ornament(Brush& b) {
  constexpr int kRows = 3;
  constexpr int kAcross = 2;
  b.fill(b.grey(180, 200, 5));
  b.rectangle(0, 0.93, 1, 1, b.grey(80, 100, 6));
  for (int row = 0; row < kRows; ++row) {
    const Colour inlay = b.grey(75, 110, 10);
    for (int i = 0; i < kAcross; ++i) {
      const double x = (i + 0.5) / kAcross + b.between(-0.05, 0.05);
      const double y = 0.9 * (row + 0.5) / kRows + b.between(-0.03, 0.03);
      b.polygon(x, y, b.between(0.1, 0.14), row % 2 ? 4 : 3, inlay);
    }
  }
}

/// Band-limited noise of low contrast: ground that is not uniform and has few corners.
void paint_ground(Brush& b) {
  const Colour base = b.grey(105, 125, 4);
  b.fill(base);
  // a few waves of whole periods: smooth, and tiles seamlessly
  struct Wave {
    int across, down;
    double phase, amplitude;
  };
  std::array<Wave, 12> waves;
  for (Wave& w : waves) {
    w = {static_cast<int>(b.between(-7, 8)), static_cast<int>(b.between(1, 8)),
         b.between(0, 2 * CV_PI), b.between(0.5, 2.5)};
  }
  // sin(x + y) of each wave, from the sines and cosines of its columns and rows
  cv::Mat1d brightness(b.height(), b.width(), 0.0);
  std::vector<double> sine(static_cast<std::size_t>(b.width())), cosine(sine.size());
  for (const Wave& w : waves) {
    for (int x = 0; x < b.width(); ++x) {
      const double angle = 2 * CV_PI * w.across * (x + 0.5) / b.width() + w.phase;
      sine[static_cast<std::size_t>(x)] = w.amplitude * std::sin(angle);
      cosine[static_cast<std::size_t>(x)] = w.amplitude * std::cos(angle);
    }
    for (int y = 0; y < b.height(); ++y) {
      const double angle = 2 * CV_PI * w.down * (y + 0.5) / b.height();
      const double s = std::sin(angle), c = std::cos(angle);
      double* row = brightness[y];
      for (std::size_t x = 0; x < sine.size(); ++x) row[x] += sine[x] * c + cosine[x] * s;
    }
  }
  for (int y = 0; y < b.height(); ++y) {
    for (int x = 0; x < b.width(); ++x) {
      b.at(y, x) = cv::Vec3d(base) + cv::Vec3d::all(brightness(y, x));
    }
  }
}

struct Style {
  std::string_view name;
  void (*paint)(Brush&);
};
constexpr Style kStyles[] = {
    {"bricks", paint_bricks},   {"cabinet", paint_cabinet},   {"carton", paint_carton},
    {"crate", paint_crate},     {"fewrects", paint_fewrects}, {"ground", paint_ground},
    {"metal", paint_metal},     {"ornament", paint_ornament}, {"panel", paint_panel},
    {"picture", paint_picture}, {"plinth", paint_plinth},     {"polygons", paint_polygons},
    {"rects", paint_rects},     {"windows", paint_windows}};

/// A face of a cube texture in GL's layout, from an image that appears upright from outside with z
/// up. The rotations convert from GL's y-up convention; top and bottom have no upright.
cv::Mat3b as_cube_face(const cv::Mat3b& picture, int face) {
  constexpr cv::RotateFlags kTurns[] = {cv::ROTATE_90_COUNTERCLOCKWISE, cv::ROTATE_90_CLOCKWISE,
                                        cv::ROTATE_180};  // of +x, -x and +y
  if (face > 2) return picture;
  cv::Mat3b out;
  cv::rotate(picture, out, kTurns[face]);
  return out;
}

}  // namespace

const std::vector<std::string>& texture_styles() {
  constexpr auto kNames = kStyles | std::views::transform(&Style::name);
  static const std::vector<std::string> names(kNames.begin(), kNames.end());
  return names;
}

bool is_texture_style(std::string_view name) {
  return std::ranges::count(texture_styles(), name) > 0;
}

std::string_view procedural_style(std::string_view texture_name) {
  const std::size_t at = texture_name.find(kProceduralPrefix);
  if (at == std::string_view::npos) return {};
  const std::string_view style = texture_name.substr(at + kProceduralPrefix.size());
  return style.substr(0, style.find(':'));
}

cv::Mat3b paint(std::string_view style, int width_px, int height_px, RandomStream random) {
  const auto* found = std::ranges::find(kStyles, style, &Style::name);
  if (found == std::end(kStyles)) {
    throw std::invalid_argument(fmt::format("no texture style is called '{}'; there are {}", style,
                                            fmt::join(texture_styles(), ", ")));
  }
  cv::Mat3b picture(height_px, width_px);
  Brush brush(picture, random);
  found->paint(brush);
  return picture;
}

void fill_texture(Model& model, int texture, const cv::Mat3b& picture) {
  const mjModel& m = model.m();
  const int width = m.tex_width[texture];
  const int channels = m.tex_nchannel[texture];
  const bool cube = m.tex_type[texture] != mjTEXTURE_2D;
  const int faces = cube ? m.tex_height[texture] / width : 1;
  const int face_height = m.tex_height[texture] / faces;
  cv::Mat3b scaled;
  cv::resize(picture, scaled, {width, face_height}, 0, 0, cv::INTER_AREA);

  mjtByte* to = m.tex_data + m.tex_adr[texture];
  for (int face = 0; face < faces; ++face) {
    const cv::Mat3b image = cube ? as_cube_face(scaled, face) : scaled;
    for (const Colour& pixel : image) {
      for (int c = 0; c < channels; ++c) *to++ = c < 3 ? pixel[c] : 255;
    }
  }
}

void fill_procedural_texture(Model& model, int texture, std::uint64_t scenario_seed) {
  const mjModel& m = model.m();
  const std::string_view name = model.name(mjOBJ_TEXTURE, texture);
  const std::string_view style = procedural_style(name);
  if (style.empty()) return;
  const int width = m.tex_width[texture];
  const int height = m.tex_type[texture] == mjTEXTURE_2D ? m.tex_height[texture] : width;
  const RandomStream random(scenario_seed, "texture/" + std::string(name));
  fill_texture(model, texture, paint(style, width, height, random));
}

}  // namespace lcs::sim
