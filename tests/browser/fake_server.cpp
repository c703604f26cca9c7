// SPDX-License-Identifier: Apache-2.0
// The door for browsers with pictures made up here: for tests of the page, and work on it, without
// renderers. Prints the line with the URL that `eyrie serve` prints, and serves until its standard
// input ends, with --h264 as the program's option, and on --host's address or 127.0.0.1; a line "no
// renderer" or "renderer" on it takes the renderer away or brings it back, and "wall" hangs the
// picture on two screens that share a swap barrier. With --film pictures of moving views are made
// beforehand, by no software renderer: what is left of the time from an input to its picture is all
// but rendering.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "coordinator/config/screen.h"
#include "coordinator/http/server.h"
#include "fabric/frustum.h"
#include "tests/coordinator/fake_frame_source.h"
#include "video/load.h"

namespace {

using namespace eyrie;

/// Where the ray meets the ground z = 0, as a chequered plain under a sky.
fabric::Rgba colourAlong(const fabric::Vec3& eye, const fabric::Vec3& direction) {
    if (direction.z >= 0 || eye.z <= 0) {
        const auto height = static_cast<int>(80 * std::clamp(direction.z, 0.0, 1.0));
        return {static_cast<std::uint8_t>(60 + height), static_cast<std::uint8_t>(90 + height),
                static_cast<std::uint8_t>(130 + height), 255};
    }
    const fabric::Vec3 hit = eye - direction * (eye.z / direction.z);
    const bool isInside = hit.x >= 0 && hit.x <= 100 && hit.y >= 0 && hit.y <= 100;
    if (!isInside)
        return {38, 44, 54, 255};
    const bool isDark = (static_cast<int>(hit.x / 10) + static_cast<int>(hit.y / 10)) % 2 == 0;
    const auto red = static_cast<std::uint8_t>(60 + 1.5 * hit.x);
    const auto green = static_cast<std::uint8_t>(60 + 1.5 * hit.y);
    return isDark ? fabric::Rgba{red, green, 60, 255} : fabric::Rgba{green, 150, red, 255};
}

/// The screens, in the camera's axes: they meet in a corner ahead.
const config::Wall kLeft{{-1.7, -0.6, -0.2}, {0, -0.6, -1.2}, {-1.7, 0.6, -0.2}, false};
const config::Wall kRight{{0, -0.6, -1.2}, {1.7, -0.6, -0.2}, {0, 0.6, -1.2}, false};
constexpr double kEye = 0.1;  ///< of two eyes, beside the middle

/// By which sight a picture is seen; nothing: the camera's own.
std::optional<fabric::Sight> sightOf(const coordinator::Shown& shown) {
    if (shown.segment.empty())
        return std::nullopt;
    const double x = shown.eye == compound::Eye::Left    ? -kEye
                     : shown.eye == compound::Eye::Right ? kEye
                                                         : 0;
    return config::sightThrough(shown.segment == "left" ? kLeft : kRight, {x, 0, 0});
}

/// From the eye through a place of a picture, in shares of it; in the world.
struct Line {
    fabric::Vec3 eye;
    fabric::Vec3 direction;
};

/// The lines of sight of a picture.
class Lines {
public:
    Lines(const fabric::Camera& camera, const std::optional<fabric::Sight>& sight, double aspect)
        : frustum_(sight ? sight->frustum : fabric::symmetricFrustum(camera.fovYDegrees, aspect)),
          eye_(camera.eye),
          worldFromView_(glm::transpose(fabric::viewFromWorldRotation(camera))) {
        if (!sight)
            return;
        eye_ += worldFromView_ * sight->eye;
        worldFromView_ = worldFromView_ * glm::transpose(sight->viewFromCamera);
    }

    /// `at` from (0, 0), the lower left corner, to (1, 1).
    Line through(const fabric::Vec2& at) const {
        const fabric::Vec3 inView(frustum_.left + at.x * (frustum_.right - frustum_.left),
                                  frustum_.bottom + at.y * (frustum_.top - frustum_.bottom), -1);
        return {eye_, worldFromView_ * inView};
    }

private:
    fabric::Frustum frustum_;
    fabric::Vec3 eye_;
    fabric::Mat3 worldFromView_;
};

void paint(const coordinator::FrameRequest& request, const std::optional<fabric::Sight>& sight,
           fabric::Image& image) {
    const Lines lines(request.camera, sight, static_cast<double>(request.width) / request.height);
    std::size_t i = 0;
    for (int y = 0; y < request.height; ++y)
        for (int x = 0; x < request.width; ++x) {
            const Line line =
                lines.through({(x + 0.5) / request.width, (y + 0.5) / request.height});
            image.colour[i++] = colourAlong(line.eye, line.direction);
        }
}

coordinator::RenderedFrame draw(const coordinator::FrameRequest& request) {
    coordinator::RenderedFrame frame = coordinator::plainFrame(request, {});
    for (std::size_t k = 0; k < frame.pictures.size(); ++k) {
        const std::optional<fabric::Sight> sight = sightOf(request.shown[k]);
        paint(request, sight, k == 0 ? frame.image : frame.further[k - 1]);
        if (sight)
            frame.pictures[k].seen = {{{0, 0}, {1, 1}, *sight}};
    }
    if (request.look.saturation == 0)
        for (fabric::Rgba& one : frame.image.colour) one.r = one.b = one.g;
    // As renderers do: half the error costs four times the triangles, and the data end somewhere.
    frame.statistics.tauAchievedPixels = std::max(0.5, request.tauPixels * 0.9);
    frame.statistics.triangles = std::min<std::uint64_t>(
        1'000'000, static_cast<std::uint64_t>(200'000 / (request.tauPixels * request.tauPixels)));
    frame.statistics.milliseconds.total = 12;
    return frame;
}

/// Pictures of an orbit, made when the first of their size is asked for, and shown by turns
/// whatever is asked for. What copying one takes is told as the time of rendering.
class Film {
public:
    coordinator::RenderedFrame next(const coordinator::FrameRequest& request) {
        const auto start = std::chrono::steady_clock::now();
        const std::lock_guard lock(mutex_);
        std::vector<coordinator::RenderedFrame>& pictures = made_[{request.width, request.height}];
        if (pictures.empty())
            for (int i = 0; i < kPictures; ++i) pictures.push_back(made(request, i));
        coordinator::RenderedFrame frame = pictures[shown_++ % kPictures];
        frame.statistics.milliseconds.total =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count();
        return frame;
    }

private:
    static constexpr int kPictures = 8;

    static coordinator::RenderedFrame made(coordinator::FrameRequest request, int place) {
        constexpr double kTurn = 0.01;  ///< radians from one to the next, as a hand turns
        const fabric::Vec3 arm = request.camera.eye - request.camera.target;
        const double cos = std::cos(kTurn * place);
        const double sin = std::sin(kTurn * place);
        request.camera.eye = request.camera.target + fabric::Vec3(cos * arm.x - sin * arm.y,
                                                                  sin * arm.x + cos * arm.y, arm.z);
        coordinator::RenderedFrame frame = draw(request);
        frame.device.software = false;
        return frame;
    }

    std::mutex mutex_;
    std::map<std::pair<int, int>, std::vector<coordinator::RenderedFrame>> made_;
    std::size_t shown_ = 0;
};

/// The same plain, picked.
fabric::Picked pick(const fabric::PickRequest& request) {
    const double aspect = static_cast<double>(request.viewWidth) / request.viewHeight;
    const Line line =
        Lines(request.camera, request.sight, aspect)
            .through({request.place.x / request.viewWidth, request.place.y / request.viewHeight});
    const double t = -line.eye.z / line.direction.z;
    const fabric::Vec3 hit = line.eye + line.direction * t;
    if (!(t > 0) || hit.x < 0 || hit.x > 100 || hit.y < 0 || hit.y > 100)
        return std::nullopt;
    fabric::PickedPoint point;
    point.worldMetres = hit;
    point.distanceMetres = t * glm::length(line.direction);
    point.errorMetres = 0.25;
    point.nearestMetres = point.distanceMetres - 1.5;
    point.farthestMetres = point.distanceMetres + 2.5;
    point.pixelMetres = 0.1;
    point.elevationMetres = 1234.56;
    point.elevationErrorMetres = 0.25;
    return point;
}

/// To be in time a picture is half as wide and high, and its error larger.
coordinator::RenderedFrame drawInTime(const coordinator::FrameRequest& request) {
    if (!request.budgetMilliseconds)
        return draw(request);
    coordinator::FrameRequest made = request;
    made.width /= 2;
    made.height /= 2;
    made.tauPixels = std::max(4.0, request.tauPixels);
    coordinator::RenderedFrame frame = draw(made);
    frame.statistics.tauAskedPixels = request.tauPixels;
    frame.statistics.budget =
        fabric::BudgetUse{*request.budgetMilliseconds, 0.9 * *request.budgetMilliseconds,
                          made.tauPixels, frame.statistics.triangles, 1};
    return frame;
}

coordinator::Status statusWith(bool hasRenderer, bool hasWall, bool isSoftware) {
    coordinator::Status status = coordinator::readyStatus();
    status.renderers[0].device.software = isSoftware;
    status.renderers[0].device.renderer = "made-up pictures (no renderer)";
    fabric::GroundGrid plain;
    plain.worldFromGrid[0].x = plain.worldFromGrid[1].y = 2000;
    plain.worldFromGrid[3] = {-1000, -1000, 0, 1};
    plain.columns = plain.rows = 1;
    plain.highest = {0};
    plain.lowest = {0};
    status.sceneInfo.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(1, plain);
    if (hasWall)
        status.canvases = {{.name = "wall",
                            .segments = {"left", "right"},
                            .layouts = {"1"},
                            .layout = "1",
                            .barriers = {"corner", {"corner", "corner"}}}};
    if (!hasRenderer) {
        status.renderers.clear();
        status.problem = "No renderer has registered.";
    }
    return status;
}

absl::StatusOr<fabric::SeenAreas> seen(const coordinator::FrameRequest& request) {
    const coordinator::Shown& shown = request.shown.front();
    if (!shown.segment.empty() && shown.segment != "left" && shown.segment != "right")
        return absl::NotFoundError(fmt::format(
            "no segment is called \"{}\"; there are \"left\", \"right\"", shown.segment));
    const std::optional<fabric::Sight> sight = sightOf(shown);
    if (!sight)
        return fabric::SeenAreas();
    return fabric::SeenAreas{{{{0, 0}, {1, 1}, *sight}}};
}

/// Takes `name` and its value out of the arguments.
std::optional<std::string> takeValue(std::vector<std::string_view>& arguments,
                                     std::string_view name) {
    const auto option = std::find(arguments.begin(), arguments.end(), name);
    if (option == arguments.end() || option + 1 == arguments.end())
        return std::nullopt;
    std::string value(*(option + 1));
    arguments.erase(option, option + 2);
    return value;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string_view> arguments(argv + 1, argv + argc);
    const std::optional<std::string> host = takeValue(arguments, "--host");
    const bool hasVideo = std::erase(arguments, "--h264") > 0;
    const bool isFilm = std::erase(arguments, "--film") > 0;
    if (arguments.size() != 1 && arguments.size() != 2) {
        std::cerr << "usage: fake_server WEB_FOLDER [PORT] [--host ADDRESS] [--h264] [--film]\n";
        return 2;
    }
    Film film;
    const coordinator::FakeFrameSource::Draw drawn = [&](const coordinator::FrameRequest& request) {
        return isFilm ? film.next(request) : drawInTime(request);
    };
    coordinator::FakeFrameSource frames;
    frames.setDraw(drawn);
    frames.setPick(pick);
    frames.setSeen(seen);
    frames.setStatus(statusWith(true, false, !isFilm));
    http::ServerOptions options;
    options.host = host.value_or(options.host);
    if (arguments.size() == 2)
        options.port = static_cast<std::uint16_t>(std::stoi(std::string(arguments[1])));
    options.webFolder = std::string(arguments[0]);
    if (hasVideo) {
        const auto module = video::load();
        if (!module.ok()) {
            std::cerr << module.status() << '\n';
            return 1;
        }
        options.video = *module;
    }
    options.swapPatience = std::chrono::minutes(2);  // however busy the machine is
    auto server = http::Server::start(options, frames);
    if (!server.ok()) {
        std::cerr << server.status() << '\n';
        return 1;
    }
    fmt::print("Eyrie is at {}\n", (*server)->url());
    std::fflush(stdout);
    bool hasWall = false;
    for (std::string line; std::getline(std::cin, line);) {
        hasWall = hasWall || line == "wall";
        frames.setStatus(statusWith(line != "no renderer", hasWall, !isFilm));
        frames.setDraw(line == "no renderer"
                           ? [](const coordinator::FrameRequest&)
                                 -> absl::StatusOr<coordinator::RenderedFrame> {
                                 return absl::UnavailableError("No renderer has registered.");
                             }
                           : drawn);
    }
    (*server)->stop();
    return 0;
}
