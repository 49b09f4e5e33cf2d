#include "scenes/worlds/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "scenarios/input/inputs_read.h"
#include "sim/pictures/picture_file.h"

namespace lcs::worlds {
namespace {

using Colour = cv::Vec3b;

uchar level(double value) {
  return static_cast<uchar>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
}

/// A random grey between the limits, tinted by up to `tint` levels per channel.
Colour colour(Draw& draw, double low, double high, double tint) {
  const double grey = draw.between(low, high);
  Colour c;
  for (int i = 0; i < 3; ++i) c[i] = level(grey + draw.between(-tint, tint));
  return c;
}

Colour shaded(const Colour& c, double factor) {
  return {level(c[0] * factor), level(c[1] * factor), level(c[2] * factor)};
}

Colour mixed(const Colour& a, const Colour& b, double share) {
  Colour c;
  for (int i = 0; i < 3; ++i) c[i] = level(a[i] + share * (b[i] - a[i]));
  return c;
}

/// Periodic noise: random values at `across` x `down` points, smoothly interpolated.
cv::Mat1f smooth_noise(Draw& draw, int side, int across, int down) {
  cv::Mat1f at(down, across);
  for (float& value : at) value = static_cast<float>(draw.between(-1, 1));
  cv::Mat1f noise(side, side);
  const auto place = [side](int pixel, int cells, int& first, float& share) {
    const float x = static_cast<float>(pixel * cells) / static_cast<float>(side);
    first = static_cast<int>(x);
    share = x - static_cast<float>(first);
    share = share * share * (3 - 2 * share);
  };
  for (int y = 0; y < side; ++y) {
    int row = 0, column = 0;
    float down_share = 0, across_share = 0;
    place(y, down, row, down_share);
    const float* above = at[row % down];
    const float* below = at[(row + 1) % down];
    for (int x = 0; x < side; ++x) {
      place(x, across, column, across_share);
      const int left = column % across, right = (column + 1) % across;
      const float top = above[left] + across_share * (above[right] - above[left]);
      const float bottom = below[left] + across_share * (below[right] - below[left]);
      noise(y, x) = top + down_share * (bottom - top);
    }
  }
  return noise;
}

/// Scales to mean 0 and standard deviation 1.
void standardise(cv::Mat1f& values) {
  double mean = 0, squares = 0;
  for (const float value : values) mean += value;
  mean /= static_cast<double>(values.total());
  for (const float value : values) squares += (value - mean) * (value - mean);
  const double deviation = std::sqrt(squares / static_cast<double>(values.total())) + 1e-9;
  for (float& value : values) value = static_cast<float>((value - mean) / deviation);
}

/// Octaves of smooth noise with weights 1, `keep`, `keep`^2, ...; mean 0, standard deviation 1.
cv::Mat1f fractal_noise(Draw& draw, int side, int cells, double keep, int stretch = 1) {
  cv::Mat1f sum(side, side, 0.F);
  float weight = 1;
  for (int n = cells; n * stretch <= side / 2; n *= 2) {
    const cv::Mat1f octave = smooth_noise(draw, side, n * stretch, n);
    std::transform(sum.begin(), sum.end(), octave.begin(), sum.begin(),
                   [weight](float a, float b) { return a + weight * b; });
    weight *= static_cast<float>(keep);
  }
  standardise(sum);
  return sum;
}

/// Adds `levels` times the pixel's value in `by` to each pixel.
void lighten(cv::Mat3b& picture, const cv::Mat1f& by, double levels) {
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      for (int c = 0; c < 3; ++c) picture(y, x)[c] = level(picture(y, x)[c] + levels * by(y, x));
    }
  }
}

/// Adds brightness noise with a standard deviation between `least` and `most` levels.
void dirty(cv::Mat3b& picture, Draw& draw, int cells, double keep, double least, double most) {
  const cv::Mat1f noise = fractal_noise(draw, picture.cols, cells, keep);
  lighten(picture, noise, draw.between(least, most));
}

/// Draws at all periodic copies of the position, so that the picture tiles.
void without_seam(int side, const auto& draw_at) {
  for (const int dy : {-side, 0, side}) {
    for (const int dx : {-side, 0, side}) draw_at(dx, dy);
  }
}

/// Overlapping discs, few large and many small: the model of natural images of Lee, Mumford & Huang
/// ("Occlusion Models for Natural Images", IJCV 2001). It looks alike from near and from afar, and
/// has edges, which 1/f noise lacks.
cv::Mat1f dead_leaves(Draw& draw, int side) {
  constexpr double kSmallest_px = 0.7;
  const double largest_px = side / 6.0;
  cv::Mat1f leaves(side, side, 0.F);
  for (int i = side * side / 9; i > 0; --i) {
    const double share = draw.between(1e-6, 1);  // their number goes with radius^-3
    const int r = static_cast<int>(std::min(largest_px, kSmallest_px / std::sqrt(share)) + 0.5);
    const cv::Point at{draw.whole(0, side - 1), draw.whole(0, side - 1)};
    const double value = draw.normal();
    without_seam(side, [&](int dx, int dy) {
      const cv::Point centre = at + cv::Point(dx, dy);
      if (std::min(centre.x, centre.y) < -r || std::max(centre.x, centre.y) >= side + r) return;
      cv::circle(leaves, centre, r, value, cv::FILLED);
    });
  }
  standardise(leaves);
  return leaves;
}

void paint_plain(cv::Mat3b& p, Draw& draw) {
  p.setTo(colour(draw, 60, 225, 35));
  dirty(p, draw, 3, 0.5, 0.5, 2.5);
}

void paint_fractal(cv::Mat3b& p, Draw& draw) {
  const Colour dark = colour(draw, 25, 110, 16), light = colour(draw, 130, 235, 16);
  const int cells = draw.whole(3, 6);
  const cv::Mat1f noise = fractal_noise(draw, p.cols, cells, draw.between(0.55, 0.85));
  std::transform(noise.begin(), noise.end(), p.begin(), [&](float value) {
    return mixed(dark, light, std::clamp(0.5 + 0.28 * value, 0.0, 1.0));
  });
}

void paint_concrete(cv::Mat3b& p, Draw& draw) {
  p.setTo(colour(draw, 100, 190, 8));
  dirty(p, draw, 2, 0.6, 4, 10);
  dirty(p, draw, 24, 0.7, 1, 5);
  const int side = p.cols;
  for (int i = draw.whole(0, 50); i > 0; --i) {  // pores
    const cv::Point at{draw.whole(0, side - 1), draw.whole(0, side - 1)};
    const int radius = draw.whole(0, 2);
    cv::circle(p, at, radius, shaded(p(at), draw.between(0.5, 0.85)), cv::FILLED);
  }
}

std::string word(Draw& draw) {
  static const std::vector<std::string> kWords{
      "EXIT",  "FRAGILE", "A4",      "No. 7",  "OPEN",   "STOP",  "CAUTION", "Line",  "market",
      "15 kg", "HANDLE",  "Bay 12",  "SALE",   "Office", "WATER", "M-204",   "Depot", "2nd floor",
      "parts", "north",   "service", "Danger", "KEEP",   "clear", "UP",      "P 3",   "Room 118"};
  if (draw.chance(0.7)) return draw.pick(kWords);
  std::string text;
  for (int i = draw.whole(3, 8); i > 0; --i) {
    text += draw.chance(0.5) ? static_cast<char>('0' + draw.whole(0, 9))
                             : static_cast<char>('A' + draw.whole(0, 25));
  }
  return text;
}

void paint_lettering(cv::Mat3b& p, Draw& draw) {
  const bool dark_ground = draw.chance(0.3);
  const Colour ground = dark_ground ? colour(draw, 30, 90, 40) : colour(draw, 160, 245, 25);
  p.setTo(ground);
  if (draw.chance(0.5)) dirty(p, draw, 3, 0.6, 1, 6);
  const int side = p.cols;
  for (int y = side / 12; y < side * 11 / 12;) {
    const int height = std::max(7, static_cast<int>(side * draw.scaled(0.035, 0.22)));
    const Colour ink = dark_ground ? colour(draw, 170, 245, 40) : colour(draw, 10, 100, 45);
    const int font = draw.pick({cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX,
                                cv::FONT_HERSHEY_COMPLEX, cv::FONT_HERSHEY_TRIPLEX});
    const double scale = height / 22.0;
    const int thickness = std::max(1, height / 9);
    int x = static_cast<int>(side * draw.between(0.03, 0.12));
    while (x < side * 0.8) {
      const std::string text = word(draw);
      const int width = cv::getTextSize(text, font, scale, thickness, nullptr).width;
      if (x + width > side - 2) break;
      cv::putText(p, text, {x, y + height}, font, scale, ink, thickness, cv::LINE_AA);
      x += width + height / 2;
    }
    y += height + height / 2 + 2;
    if (draw.chance(0.15)) {
      cv::rectangle(p, {side / 16, y}, {side * 15 / 16, y + std::max(1, height / 10)}, ink,
                    cv::FILLED);
      y += height / 2;
    }
  }
}

void paint_wood(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  const int planks = draw.whole(2, 8);
  const Colour base{level(draw.between(40, 110)), level(draw.between(75, 150)),
                    level(draw.between(110, 195))};
  const cv::Mat1f grain = fractal_noise(draw, side, 2, 0.75, 16);
  const double depth = draw.between(5, 18);
  for (int i = 0; i < planks; ++i) {
    const int left = side * i / planks, right = side * (i + 1) / planks;
    const Colour tone = shaded(base, draw.between(0.8, 1.2));
    const int shift = draw.whole(0, side - 1);
    for (int y = 0; y < side; ++y) {
      for (int x = left; x < right; ++x) {
        const double g = depth * grain((y + shift) % side, x);
        p(y, x) = {level(tone[0] + g), level(tone[1] + g), level(tone[2] + g)};
      }
    }
    cv::line(p, {left, 0}, {left, side - 1}, shaded(base, 0.45), 1 + side / 256);
    const int end = draw.whole(0, side - 1);
    cv::line(p, {left, end}, {right - 1, end}, shaded(base, 0.5), 1);
  }
  if (draw.chance(0.5)) cv::transpose(p, p);
}

/// \param bond shift of every other row, in bricks.
void paint_courses(cv::Mat3b& p, Draw& draw, int rows, int columns, double bond,
                   const Colour& joint, const std::vector<Colour>& tones, double vary) {
  const int side = p.cols;
  const int gap = std::max(1, static_cast<int>(side * draw.between(0.004, 0.012)));
  p.setTo(joint);
  for (int row = 0; row < rows; ++row) {
    const int top = side * row / rows + gap, bottom = side * (row + 1) / rows - gap;
    for (int column = 0; column < columns; ++column) {
      const double shift = row % 2 == 1 ? bond : 0;
      const int left = static_cast<int>(side * (column + shift) / columns) + gap;
      const int right = static_cast<int>(side * (column + 1 + shift) / columns) - gap;
      const Colour tone = shaded(
          tones[static_cast<std::size_t>(row * columns + column) % 2 == 0 ? 0 : tones.size() - 1],
          draw.between(1 - vary, 1 + vary));
      for (const int wrap : {0, -side}) {
        cv::rectangle(p, {left + wrap, top}, {right + wrap, bottom}, tone, cv::FILLED);
      }
    }
  }
}

void paint_bricks(cv::Mat3b& p, Draw& draw) {
  const Colour brick = draw.chance(0.7)
                           ? Colour{level(draw.between(40, 90)), level(draw.between(55, 105)),
                                    level(draw.between(110, 185))}
                           : colour(draw, 90, 200, 15);
  const int rows = 2 * draw.whole(3, 6);
  paint_courses(p, draw, rows, rows / 2, 0.5, colour(draw, 120, 215, 10), {brick}, 0.18);
  dirty(p, draw, 12, 0.7, 2, 8);
}

void paint_tiles(cv::Mat3b& p, Draw& draw) {
  const int count = 2 * draw.whole(1, 4);
  const Colour one = colour(draw, 90, 230, 25);
  std::vector<Colour> tones{one};
  const bool checkered = draw.chance(0.3);
  if (checkered) tones.push_back(colour(draw, 40, 200, 25));
  const bool odd = draw.chance(0.3);
  const Colour grout = shaded(one, draw.between(0.5, 0.9));
  paint_courses(p, draw, count, count, odd ? 0.5 : 0, grout, tones, draw.between(0.01, 0.08));
  if (draw.chance(0.5)) dirty(p, draw, 4, 0.6, 1, 5);
}

void paint_stripes(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  const int bars = draw.whole(2, 9);
  const Colour a = colour(draw, 20, 120, 50), b = colour(draw, 120, 245, 50);
  const double share = draw.between(0.2, 0.7);
  const int slant = draw.chance(0.35) ? 1 : 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int phase = ((x + slant * y) * bars) % side;
      p(y, x) = phase < share * side ? a : b;
    }
  }
  if (!slant && draw.chance(0.5)) cv::transpose(p, p);
  if (draw.chance(0.6)) dirty(p, draw, 4, 0.6, 1, 7);
}

void paint_grille(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  p.setTo(colour(draw, 15, 70, 10));
  const Colour bar = colour(draw, 110, 220, 25);
  const int across = draw.whole(3, 9), down = draw.chance(0.5) ? across : draw.whole(1, 4);
  const int width = std::max(2, static_cast<int>(side * draw.between(0.015, 0.04)));
  for (int i = 0; i < across; ++i) {
    const int x = side * i / across;
    cv::rectangle(p, {x, 0}, {x + width, side - 1}, bar, cv::FILLED);
  }
  for (int i = 0; i < down; ++i) {
    const int y = side * i / down;
    cv::rectangle(p, {0, y}, {side - 1, y + width}, shaded(bar, 0.85), cv::FILLED);
  }
}

void paint_corrugated(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  const int waves = draw.whole(4, 14);
  const Colour base = colour(draw, 90, 190, 45);
  const double depth = draw.between(0.15, 0.4);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double t = static_cast<double>((x * waves) % side) / side;  // a flat top and a slope
      const double from_ridge = std::max({0.0, t < 0.6 ? t - 0.35 : 0.85 - t, -1.0});
      p(y, x) = shaded(base, 1 - depth * std::min(1.0, (t < 0.85 ? from_ridge : 0) / 0.15));
    }
  }
  dirty(p, draw, 3, 0.65, 1, 8);
}

void paint_foliage(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  const bool dry = draw.chance(0.25);
  const Colour ground{level(draw.between(10, 40)), level(draw.between(30, 60)),
                      level(draw.between(15, 45))};
  p.setTo(ground);
  const int leaves = draw.whole(350, 900);
  const double size = side * draw.between(0.012, 0.035);
  for (int i = 0; i < leaves; ++i) {
    const double light = draw.between(0.35, 1.15) * (0.6 + 0.4 * i / leaves);
    const Colour leaf = dry ? shaded({75, 160, 195}, light)
                            : shaded({65, level(draw.between(145, 205)), 105}, light);
    const cv::Point at{draw.whole(0, side - 1), draw.whole(0, side - 1)};
    const cv::Size axes{std::max(1, static_cast<int>(size * draw.between(0.7, 1.6))),
                        std::max(1, static_cast<int>(size * draw.between(0.3, 0.7)))};
    const int angle = draw.whole(0, 179);
    without_seam(side, [&](int dx, int dy) {
      cv::ellipse(p, {at.x + dx, at.y + dy}, axes, angle, 0, 360, leaf, cv::FILLED);
    });
  }
}

void paint_worn(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  const Colour paint = colour(draw, 60, 210, 40), below = colour(draw, 40, 150, 20);
  const cv::Mat1f chips = fractal_noise(draw, side, draw.whole(3, 5), 0.7);
  const double above = draw.between(0.9, 1.9);
  std::transform(chips.begin(), chips.end(), p.begin(),
                 [&](float chip) { return chip > above ? below : paint; });
  for (int i = draw.whole(5, 40); i > 0; --i) {
    const cv::Point from{draw.whole(0, side - 1), draw.whole(0, side - 1)};
    const cv::Point by{draw.whole(-side / 6, side / 6), draw.whole(-side / 12, side / 12)};
    const Colour& of = draw.chance(0.5) ? below : paint;
    const Colour c = shaded(of, draw.between(0.8, 1.3));
    without_seam(side, [&](int dx, int dy) {
      cv::line(p, from + cv::Point(dx, dy), from + by + cv::Point(dx, dy), c, 1, cv::LINE_AA);
    });
  }
  dirty(p, draw, 2, 0.6, 2, 8);
}

void paint_speckle(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  const Colour ground = colour(draw, 50, 210, 12);
  p.setTo(ground);
  const double contrast = draw.between(15, 90);
  const int largest = draw.whole(1, 3);
  for (int i = draw.whole(side * side / 160, side * side / 40); i > 0; --i) {
    const cv::Point at{draw.whole(0, side - 1), draw.whole(0, side - 1)};
    const double by = draw.between(-contrast, contrast);
    const Colour c{level(ground[0] + by), level(ground[1] + by), level(ground[2] + by)};
    const int radius = draw.whole(0, largest);
    without_seam(side, [&](int dx, int dy) {
      cv::circle(p, {at.x + dx, at.y + dy}, radius, c, cv::FILLED);
    });
  }
}

void paint_facade(cv::Mat3b& p, Draw& draw) {
  const int side = p.cols;
  if (draw.chance(0.4)) {
    paint_bricks(p, draw);
  } else {
    p.setTo(colour(draw, 110, 225, 30));
    dirty(p, draw, 4, 0.65, 1, 6);
  }
  const int rows = draw.whole(1, 3), columns = draw.whole(1, 4);
  const double w = draw.between(0.35, 0.65), h = draw.between(0.45, 0.7);
  const Colour frame = colour(draw, 60, 240, 20), glass = colour(draw, 25, 110, 20);
  const int line = std::max(2, side / 100);
  const int bars_across = draw.whole(0, 2), bars_down = draw.whole(0, 2);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double cx = (column + 0.5) * side / columns, cy = (row + 0.5) * side / rows;
      const cv::Rect hole(static_cast<int>(cx - w * side / columns / 2),
                          static_cast<int>(cy - h * side / rows / 2),
                          static_cast<int>(w * side / columns), static_cast<int>(h * side / rows));
      cv::rectangle(p, hole, shaded(glass, draw.between(0.7, 1.5)), cv::FILLED);
      cv::rectangle(p, hole, frame, line);
      for (int i = 1; i <= bars_across; ++i) {
        const int x = hole.x + hole.width * i / (bars_across + 1);
        cv::line(p, {x, hole.y}, {x, hole.br().y}, frame, line);
      }
      for (int i = 1; i <= bars_down; ++i) {
        const int y = hole.y + hole.height * i / (bars_down + 1);
        cv::line(p, {hole.x, y}, {hole.br().x, y}, frame, line);
      }
      if (draw.chance(0.5)) {  // a sill
        cv::rectangle(p, {hole.x - line, hole.br().y}, {hole.br().x + line, hole.br().y + 2 * line},
                      shaded(frame, 0.7), cv::FILLED);
      }
    }
  }
}

/// In the order of `Style`.
constexpr StyleInfo kStyles[] = {{"plain", paint_plain, true, 1.5, 4},
                                 {"fractal", paint_fractal, true, 0.6, 2},
                                 {"concrete", paint_concrete, true, 1.5, 4},
                                 {"lettering", paint_lettering, false, 0.5, 1.2, "text"},
                                 {"wood", paint_wood, false, 0.5, 1.2},
                                 {"bricks", paint_bricks, false, 0.5, 1.2, "pattern"},
                                 {"tiles", paint_tiles, false, 0.4, 1.6, "pattern"},
                                 {"stripes", paint_stripes, false, 0.3, 1, "pattern"},
                                 {"grille", paint_grille, false, 0.3, 1, "pattern"},
                                 {"corrugated", paint_corrugated, false, 0.5, 1.2, "pattern"},
                                 {"foliage", paint_foliage, true, 0.5, 1.2, "foliage"},
                                 {"worn", paint_worn, true, 0.6, 2},
                                 {"speckle", paint_speckle, true, 0.3, 1, "speckle"},
                                 {"facade", paint_facade, false, 3, 7, "pattern"}};

}  // namespace

const StyleInfo& info_of(Style style) {
  return kStyles[static_cast<std::size_t>(style)];
}

cv::Mat3b paint(Style style, int side_px, Draw& draw) {
  cv::Mat3b picture(side_px, side_px);
  info_of(style).paint(picture, draw);
  return picture;
}

void weather(cv::Mat3b& picture, double levels, Draw& draw) {
  const double own = levels * draw.between(0.7, 1.3);
  if (draw.chance(0.75)) {
    lighten(picture, dead_leaves(draw, picture.cols), own);
    return;
  }
  const int cells = draw.whole(2, 8);
  lighten(picture, fractal_noise(draw, picture.cols, cells, draw.between(0.75, 1.05)), own);
}

void fade(cv::Mat3b& picture, double contrast) {
  cv::Vec3d sum(0, 0, 0);
  for (const Colour& c : picture) sum += c;
  const double pixels = static_cast<double>(picture.total());
  const Colour mean{level(sum[0] / pixels), level(sum[1] / pixels), level(sum[2] / pixels)};
  for (Colour& c : picture) c = mixed(mean, c, contrast);
}

std::vector<std::string> pictures_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  input::note_input(folder);
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string extension = entry.path().extension().string();
    constexpr std::array<std::string_view, 4> kKnown{".png", ".jpg", ".jpeg", ".bmp"};
    if (!entry.is_regular_file() || std::ranges::count(kKnown, extension) == 0) continue;
    files.push_back(entry.path().string());
  }
  if (files.empty()) {
    throw std::runtime_error("there is no picture (.png, .jpg, .jpeg, .bmp) in '" + folder +
                             "'; give a folder of pictures");
  }
  std::sort(files.begin(), files.end());
  return files;
}

cv::Mat3b photograph(const std::vector<std::string>& files, int side_px, Draw& draw) {
  const std::string& file = draw.pick(files);
  const cv::Mat3b whole = sim::read_picture(file, {file, 0}, cv::IMREAD_COLOR);
  const int shorter = std::min(whole.cols, whole.rows);
  const int side = std::max(1, static_cast<int>(shorter * draw.between(0.6, 1)));
  const cv::Rect part{draw.whole(0, whole.cols - side), draw.whole(0, whole.rows - side), side,
                      side};
  cv::Mat3b picture;
  cv::resize(whole(part), picture, {side_px, side_px}, 0, 0,
             side > side_px ? cv::INTER_AREA : cv::INTER_LINEAR_EXACT);
  return picture;
}

}  // namespace lcs::worlds
