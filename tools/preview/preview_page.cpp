#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <string_view>
#include <vector>

#include "tools/preview/preview.h"
#include "tools/report/page_writer.h"
#include "tools/scoring/events.h"

namespace lcs::preview {

extern const std::string_view kPreviewCss;  // preview.css

namespace {

using Eigen::Vector2d;
using report::Html;

/// Index of a mover's colour; the rover has its own.
int colour_of(std::size_t mover) {
  return 1 + static_cast<int>(mover % 4);
}

/// The least of 1, 2 or 5 times a power of ten that is at least `least`.
double round_number(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10 * power;
}

class PreviewPage : public report::TextPage {
 public:
  PreviewPage(const scenario::Scenario& scenario, const Preview& preview)
      : TextPage(scenario.name + ": preview", kPreviewCss),
        scenario_(scenario),
        preview_(preview),
        survey_(preview.survey) {
    head();
    add("<h2>From above</h2>\n");
    plan();
    movers();
    add("<h2>What the camera sees</h2>\n<div class=\"pictures\">\n");
    const std::size_t last = preview_.looks.size() - 1;
    for (const std::size_t look : {std::size_t{0}, last / 2, last}) picture(look);
    const cv::Size shown_px = preview_.looks.front().image_px;
    const bool is_smaller = shown_px.width < scenario.camera.width_px;
    add("</div>\n<p class=\"small quiet\">Yellow: corners. Boxes: actors.{}</p>\n",
        is_smaller ? fmt::format(" Pictures and corners are made at {} x {} pixels.",
                                 shown_px.width, shown_px.height)
                   : "");
    corners();
  }

 private:
  double time_s(int frame) const { return frame / scenario_.camera.rate_hz; }

  void head() {
    const scenario::Camera& camera = scenario_.camera;
    add("<header>\n<h1>{}</h1>\n<p>{}</p>\n<div class=\"facts\"><span><b>{}</b> frames at {:g} Hz, "
        "<b>{:.1f} s</b></span><span>camera <b>{}x{}</b>, {:.0f} deg high</span><span>scene "
        "<b>{}</b></span><span>seed {}</span></div>\n",
        scenario_.name, scenario_.purpose, scenario_.frames, camera.rate_hz,
        time_s(scenario_.frames), camera.width_px, camera.height_px,
        camera.fovy_rad * 180 / std::numbers::pi, scenario_.scene.filename().string(),
        scenario_.seed);
    if (preview_.wrong.empty()) {
      add("<p class=\"fine\">Nothing is wrong that can be seen without a run.</p>\n");
    } else {
      add("<div class=\"wrong\"><b>What is wrong</b><ul>\n");
      for (const std::string& line : preview_.wrong) add("<li>{}</li>\n", line);
      add("</ul></div>\n");
    }
    add("</header>\n");
  }

  /// The region of W that the plan shows, m, and its scale.
  struct Window {
    Eigen::AlignedBox2d box = {};
    double scale = 1;  ///< px of the drawing for a metre

    Vector2d at(const Vector2d& p) const {
      return scale * Vector2d(p.x() - box.min().x(), box.max().y() - p.y());
    }
    std::string points(const std::vector<Vector2d>& all) const {
      std::string text;
      for (const Vector2d& p : all) text += fmt::format("{:.1f},{:.1f} ", at(p).x(), at(p).y());
      return text;
    }
  };

  /// All paths with a margin.
  Window window() const {
    constexpr double kAround_m = 2.5, kWidth_px = 1100, kHeight_px = 640;
    Window w;
    for (const Vector2d& p : survey_.rover_m) w.box.extend(p);
    for (const PreviewMover& mover : preview_.movers) {
      for (const Vector2d& p : mover.way_m) w.box.extend(p);
    }
    w.box.min().array() -= kAround_m;
    w.box.max().array() += kAround_m;
    const Vector2d size = w.box.sizes();
    w.scale = std::min(kWidth_px / size.x(), kHeight_px / size.y());
    return w;
  }

  void polygon(const Window& w, const std::vector<Vector2d>& points, std::string_view classes,
               const Html& more = {}, std::string_view title = "") {
    add("<polygon class=\"{}\" {} points=\"{}\">", classes, more, w.points(points));
    if (!title.empty()) add("<title>{}</title>", title);
    add("</polygon>\n");
  }

  void label(const Vector2d& at_px, const std::string& text, const Html& more = {}) {
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at_px.x(), at_px.y(), more, text);
  }

  /// Occupied places of a drawing, so that texts neither overlap nor are cut.
  struct Labels {
    Eigen::AlignedBox2d room;  ///< the drawing's area
    std::vector<Eigen::AlignedBox2d> taken = {};
  };

  /// Places the text at the first free side of a box, or nowhere. Bold names try all sides, other
  /// texts the first two.
  void label_beside(Labels& labels, const Eigen::AlignedBox2d& box, const std::string& text,
                    double height, bool bold) {
    const double letter = (bold ? 0.66 : 0.58) * height, gap = 0.4 * height;
    const double left = box.min().x() - letter * static_cast<double>(text.size()) - gap;
    const double right = box.max().x() + gap;
    const double above = box.min().y() - gap, below = box.max().y() + gap + 0.75 * height;
    // beside a small box, as paths continue above and below it
    const double start = box.sizes().x() > height ? box.min().x() : right;
    const std::array<Vector2d, 8> sides{{{start, above},
                                         {start, below},
                                         {right, above},
                                         {right, below},
                                         {left, above},
                                         {left, below},
                                         {right, above - 1.3 * height},
                                         {right, below + 1.3 * height}}};
    for (const Vector2d& at : sides | std::views::take(bold ? 8 : 2)) {
      const Eigen::AlignedBox2d place(
          at - Vector2d(0, height),
          at + Vector2d(letter * static_cast<double>(text.size()), 0.25 * height));
      const auto meets = [&](const auto& other) { return other.intersects(place); };
      if (!labels.room.contains(place) || std::ranges::any_of(labels.taken, meets)) continue;
      labels.taken.push_back(place);
      label(at, text,
            {fmt::format("style=\"font-size: {:.0f}px; font-weight: {}\"", height,
                         bold ? 700 : 400)});
      return;
    }
  }

  void grid(const Window& w, const Vector2d& size_px) {
    const double step_m = round_number(60 / w.scale);
    for (int axis = 0; axis < 2; ++axis) {
      for (double at_m = std::ceil(w.box.min()[axis] / step_m) * step_m; at_m < w.box.max()[axis];
           at_m += step_m) {
        const double x = axis == 0 ? w.at({at_m, 0}).x() : w.at({0, at_m}).y();
        const std::string text = fmt::format("{:g}", std::round(at_m / step_m) * step_m);
        if (axis == 0) {
          add("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"0\" y2=\"{1:.1f}\"/>\n", x,
              size_px.y());
          label({x + 2, size_px.y() - 4}, text + (at_m + step_m < w.box.max()[axis] ? "" : " m"));
        } else {
          add("<line class=\"grid\" y1=\"{0:.1f}\" y2=\"{0:.1f}\" x1=\"0\" x2=\"{1:.1f}\"/>\n", x,
              size_px.x());
          label({2, x - 2}, text);
        }
      }
    }
  }

  /// A time mark on a path; marks are spaced so that texts fit.
  struct Mark {
    Vector2d at;
    double t_s = 0;
  };
  std::vector<Mark> marks_of(const Window& w, const std::vector<Vector2d>& points) const {
    const double step_s = round_number(std::max(time_s(scenario_.frames) / 6, 1e-3));
    std::vector<Mark> marks;
    for (int i = 0;; ++i) {
      const double t_s = i * step_s;
      const auto k = static_cast<std::size_t>(std::lround(t_s * scenario_.camera.rate_hz));
      if (k >= points.size()) return marks;
      const Vector2d at = w.at(points[k]);
      if (marks.empty() || (at - marks.back().at).norm() >= 14) marks.push_back({at, t_s});
    }
  }

  void way(const Window& w, const std::vector<Vector2d>& points, int colour) {
    add("<polyline class=\"c{}\" points=\"{}\"/>\n", colour, w.points(points));
    for (const Mark& mark : marks_of(w, points)) {
      add("<circle class=\"c{}\" r=\"3\" fill=\"var(--panel)\" stroke-width=\"2\" cx=\"{:.1f}\" "
          "cy=\"{:.1f}\"/>\n",
          colour, mark.at.x(), mark.at.y());
    }
  }

  /// Writes names at the start of each path, then times where there is room.
  void name_ways(const Window& w, const Vector2d& size_px) {
    constexpr double kText_px = 12;
    Labels labels{{Vector2d::Zero(), size_px}};
    const auto name = [&](const Vector2d& at, const std::string& text, bool bold) {
      const Vector2d reach = Vector2d::Constant(4);
      label_beside(labels, {at - reach, at + reach}, text, kText_px, bold);
    };
    std::vector<const std::vector<Vector2d>*> ways{&survey_.rover_m};
    name(w.at(survey_.rover_m.front()), "rover", true);
    for (const PreviewMover& mover : preview_.movers) {
      name(w.at(mover.way_m.front()), mover.name, true);
      ways.push_back(&mover.way_m);
    }
    for (const auto* points : ways) {
      for (const Mark& mark : marks_of(w, *points)) {
        if (mark.t_s > 0) name(mark.at, fmt::format("{:g} s", mark.t_s), false);
      }
    }
  }

  /// The camera's field of view, up to 3 m.
  void view(const Window& w, const sim::Snapshot& snapshot) {
    constexpr double kFar_m = 3;
    const sim::Optics optics(sim::lens_of(scenario_.camera));
    const sim::Lens& lens = optics.lens();
    std::vector<Vector2d> fan{snapshot.T_WC.p.head<2>()};
    for (const double u_px : {-0.5, lens.width_px - 0.5}) {
      const double x = optics.back_project({u_px, lens.cv_px}, 1).x();
      const Eigen::Vector3d ray = snapshot.T_WC.R * Eigen::Vector3d(x, 0, 1).normalized();
      fan.push_back(fan.front() + kFar_m * ray.head<2>());
    }
    polygon(w, fan, "view");
  }

  void plan() {
    const Window w = window();
    const Vector2d size_px = w.scale * w.box.sizes();
    add("<div class=\"plan\"><svg viewBox=\"0 0 {:.1f} {:.1f}\" role=\"img\" aria-label=\"plan "
        "from above\">\n",
        size_px.x(), size_px.y());
    grid(w, size_px);
    // Omits ceilings, lamps and other things well above the camera, which would cover the plan.
    const double above_m = survey_.snapshots.front().T_WC.p.z() + 1;
    std::vector<const sim::Footprint*> prints;
    for (const sim::Footprint& print : survey_.footprints) {
      if (print.low_m < above_m) prints.push_back(&print);
    }
    std::ranges::stable_sort(prints, {}, &sim::Footprint::high_m);
    for (const sim::Footprint* print : prints) {
      if (print->object < 0) continue;
      const auto mover = std::ranges::find(preview_.movers, print->object, &PreviewMover::object);
      const std::string name =
          print->object == 0 ? ""
                             : survey_.objects[static_cast<std::size_t>(print->object - 1)].name;
      if (mover == preview_.movers.end()) {
        polygon(w, print->outline_m, print->object == 0 ? "setting" : "thing", {}, name);
        continue;
      }
      const std::string classes = fmt::format(
          "thing c{}", colour_of(static_cast<std::size_t>(mover - preview_.movers.begin())));
      polygon(w, print->outline_m, classes, {"stroke-width=\"1.5\""}, name + ", at the start");
      if (mover->moves) {
        const auto id = static_cast<std::size_t>(print->object);
        const sim::Pose moved =
            survey_.snapshots.back().T_WO[id] * survey_.snapshots.front().T_WO[id].inverse();
        std::vector<Vector2d> outline;
        for (const Vector2d& p : print->outline_m) {
          const Eigen::Vector3d at = moved * Eigen::Vector3d(p.x(), p.y(), 0);
          outline.emplace_back(at.head<2>());
        }
        polygon(w, outline, classes, {"stroke-dasharray=\"4 3\" fill-opacity=\"0.3\""},
                name + ", at the end");
      }
    }
    const std::size_t last = survey_.snapshots.size() - 1;
    for (const std::size_t k : {std::size_t{0}, last / 2, last}) view(w, survey_.snapshots[k]);
    way(w, survey_.rover_m, 0);
    for (std::size_t i = 0; i < preview_.movers.size(); ++i) {
      way(w, preview_.movers[i].way_m, colour_of(i));
    }
    name_ways(w, size_px);
    add("</svg></div>\n<p class=\"small quiet\">Ways with their times; outlines at the start, and "
        "dashed at the end; what the camera sees to 3 m off at first, in the middle and at last. "
        "Grey: static objects (names on pointing). World x is to the right, y up, in m.</p>\n");
  }

  void movers() {
    if (preview_.movers.empty()) {
      add("<p>There are no actors.</p>\n");
      return;
    }
    add("<div "
        "class=\"scroll\"><table><thead><tr><th>actor</th><th>moves</th><th>from</th><th>to</th>"
        "<th>nearest to the rover</th><th>in view</th></tr></thead><tbody>\n");
    for (std::size_t i = 0; i < preview_.movers.size(); ++i) {
      const PreviewMover& mover = preview_.movers[i];
      const Vector2d &from = mover.way_m.front(), &to = mover.way_m.back();
      add("<tr><td><i class=\"c{}\"></i>{}</td><td>{}</td><td>({:.2f}, {:.2f}) m</td><td>({:.2f}, "
          "{:.2f}) m</td><td>{:.2f} m at {:.1f} s</td><td>{} of {} pictures</td></tr>\n",
          colour_of(i), mover.name,
          mover.moves ? fmt::format("{:.1f} to {:.1f} s", mover.moves->from_s, mover.moves->to_s)
                      : "never",
          from.x(), from.y(), to.x(), to.y(), mover.nearest_m, mover.nearest_s, mover.looks,
          preview_.looks.size());
    }
    add("</tbody></table></div>\n");
  }

  void picture(std::size_t which) {
    const Look& look = preview_.looks[which];
    const double line = look.image_px.width / 640.0;
    add("<figure><svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"frame {2}\">\n<image "
        "width=\"{0}\" height=\"{1}\" href=\"data:image/jpeg;base64,{3}\"/>\n<path "
        "class=\"corners\" stroke-width=\"{4:.1f}\" d=\"",
        look.image_px.width, look.image_px.height, look.index, scoring::base64(look.jpeg),
        2.5 * line);
    for (const Eigen::Vector2f& p : preview_.corners_px[which]) {
      add("M{:.0f} {:.0f}h0", p.x() + 0.5, p.y() + 0.5);
    }
    add("\"/>\n");
    Labels labels{{Vector2d::Zero(), Vector2d(look.image_px.width, look.image_px.height)}};
    for (const sim::ObjectTruth& object : look.objects) {
      const auto mover = std::ranges::find(preview_.movers, object.object, &PreviewMover::object);
      if (mover == preview_.movers.end()) continue;
      const auto place = static_cast<std::size_t>(mover - preview_.movers.begin());
      add("<rect class=\"c{}\" stroke-width=\"{:.1f}\" x=\"{}\" y=\"{}\" width=\"{}\" "
          "height=\"{}\"/>\n",
          colour_of(place), 2 * line, object.left, object.top, object.right - object.left,
          object.bottom - object.top);
      label_beside(labels,
                   {Vector2d(object.left, object.top), Vector2d(object.right, object.bottom)},
                   mover->name, 14 * line, true);
    }
    add("</svg><figcaption>frame {}, {:.1f} s: <b>{} corners</b></figcaption></figure>\n",
        look.index, time_s(look.index), preview_.corners_px[which].size());
  }

  /// One bar for each look.
  void corners() {
    constexpr double kStep = 60, kHeight = 90;
    std::size_t most = 1;
    for (const auto& corners : preview_.corners_px) most = std::max(most, corners.size());
    add("<h3>Corners a frame</h3>\n<figure class=\"plot\"><svg viewBox=\"0 0 {:.0f} {:.0f}\" "
        "role=\"img\" aria-label=\"corners a frame\">\n",
        kStep * static_cast<double>(preview_.corners_px.size()), kHeight + 40);
    for (std::size_t i = 0; i < preview_.corners_px.size(); ++i) {
      const double x = kStep * static_cast<double>(i);
      const double high =
          kHeight * static_cast<double>(preview_.corners_px[i].size()) / static_cast<double>(most);
      add("<rect x=\"{:.0f}\" y=\"{:.1f}\" width=\"{:.0f}\" height=\"{:.1f}\" "
          "fill=\"var(--bar)\"/>\n",
          x + 4, kHeight + 20 - high, kStep - 8, high);
      label({x + kStep / 2, kHeight + 16 - high}, std::to_string(preview_.corners_px[i].size()),
            {"text-anchor=\"middle\""});
      label({x + kStep / 2, kHeight + 36}, fmt::format("{:.1f} s", time_s(preview_.looks[i].index)),
            {"text-anchor=\"middle\""});
    }
    add("</svg></figure>\n");
  }

  const scenario::Scenario& scenario_;
  const Preview& preview_;
  const sim::Survey& survey_;
};

}  // namespace

void write_preview(const std::filesystem::path& file, const scenario::Scenario& scenario,
                   const Preview& preview) {
  PreviewPage(scenario, preview).write(file);
}

}  // namespace lcs::preview
