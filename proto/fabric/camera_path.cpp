// SPDX-License-Identifier: Apache-2.0
#include "fabric/camera_path.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "fabric/status.h"

namespace eyrie::fabric {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r";
constexpr std::string_view kGaps = " \t\v\f\r,";

/// Between two steps a key at least so often, so that the curve keeps to the straight way.
constexpr double kKeysPerStep = 8;
constexpr double kDegreesPerKey = 3;

constexpr std::size_t kModelNumbers = 3;
constexpr std::size_t kStepNumbers = 7;
constexpr std::size_t kCameraNumbers = 9;

/// The numbers of all lines that are not blank, one after another.
struct Rows {
    std::vector<double> numbers;
    std::vector<std::size_t> ends;  ///< of each line's

    std::size_t count() const { return ends.size(); }
    std::span<const double> operator[](std::size_t line) const {
        const std::size_t begin = line == 0 ? 0 : ends[line - 1];
        return std::span(numbers).subspan(begin, ends[line] - begin);
    }
};

/// Decimal and finite; nullopt for all else, which from_chars takes for one, too ("inf").
std::optional<double> numberIn(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-"))
        word.remove_prefix(1);
    if (word.find_first_not_of("0123456789.eE+-") != std::string_view::npos)
        return std::nullopt;
    double number = 0;
    const auto [end, error] = std::from_chars(word.begin(), word.end(), number);
    if (error != std::errc() || end != word.end())
        return std::nullopt;
    return number;
}

bool addNumbers(std::string_view line, std::vector<double>& numbers) {
    while (true) {
        const std::size_t end = std::min(line.find_first_of(kGaps), line.size());
        const auto number = numberIn(line.substr(0, end));
        if (!number)
            return false;
        numbers.push_back(*number);
        if (end == line.size())
            return true;
        const std::size_t next = std::min(line.find_first_not_of(kGaps, end), line.size());
        line.remove_prefix(next);
    }
}

absl::StatusOr<Rows> rowsOf(std::string_view text) {
    Rows rows;
    for (int number = 1; !text.empty(); ++number) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
        line = line.substr(0, line.find_last_not_of(kBlanks) + 1);
        if (line.empty())
            continue;
        if (!addNumbers(line, rows.numbers))
            return absl::InvalidArgumentError(
                fmt::format("line {} has something else than numbers", number));
        rows.ends.push_back(rows.numbers.size());
    }
    return rows;
}

Vec3 vectorAt(std::span<const double> row, std::size_t at) {
    return {row[at], row[at + 1], row[at + 2]};
}

/// About x, then y, then z, each about the axis as it has been turned.
Mat3 turned(const Vec3& radians) {
    const Vec3 c = glm::cos(radians);
    const Vec3 s = glm::sin(radians);
    const Mat3 aboutX(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x);
    const Mat3 aboutY(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y);
    const Mat3 aboutZ(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    return aboutX * aboutY * aboutZ;
}

/// Without overflow of squares.
double length(const Vec3& v) { return std::hypot(v.x, v.y, v.z); }

double orOne(double value) { return value != 0 ? value : 1; }

/// Cameras of one scene: what no line of a path says.
struct Scene {
    Box bounds;
    double fovYDegrees = 0;

    /// As far ahead as the scene's middle is, so that orbiting goes on about it.
    Camera lookingAlong(const Vec3& eye, const Vec3& ahead, const Vec3& up) const {
        const double size = orOne(length(bounds.size()));
        const double reach =
            std::max(length(bounds.centre() - eye), 0.05 * size) / orOne(length(ahead));
        return {eye, eye + ahead * reach, up, fovYDegrees};
    }
};

struct Step {
    double frame = 0;
    Vec3 position;
    Vec3 rotation;  ///< radians about x, y and z
};

std::vector<Step> stepsOf(const Rows& rows) {
    std::vector<Step> steps;
    double frame = 0;
    for (std::size_t i = 1; i < rows.count(); ++i) {
        const auto row = rows[i];
        frame += std::max(1., std::trunc(row[0]));
        const Vec3 degrees(-row[5], row[4], row[6]);
        steps.push_back({frame, vectorAt(row, 1), degrees * (std::numbers::pi / 180)});
    }
    return steps;
}

/// How many keys the way from one step to the next has, its end left out.
double keysBetween(const Step& from, const Step& to) {
    const Vec3 turn = glm::abs(to.rotation - from.rotation);
    const double degrees = std::max({turn.x, turn.y, turn.z}) * (180 / std::numbers::pi);
    // Turns of whole keys come out of radians with rounding, which is not to make one more of them.
    const double wanted = std::max(kKeysPerStep, std::ceil(degrees / kDegreesPerKey - 1e-9));
    return std::min(to.frame - from.frame, wanted);
}

absl::Status tooManyKeys() {
    return absl::InvalidArgumentError(
        fmt::format("the path has more than {} cameras; cut it into several", kMostPathKeys));
}

/// Linear from step to step, at whole frames.
absl::StatusOr<std::vector<Step>> sampled(const std::vector<Step>& steps) {
    std::vector<Step> keys;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        const Step& from = steps[i];
        const Step& to = steps[i + 1];
        const double count = keysBetween(from, to);
        if (!(static_cast<double>(keys.size()) + count < kMostPathKeys))
            return tooManyKeys();
        for (double k = 0; k < count; ++k)
            keys.push_back({from.frame + (to.frame - from.frame) * k / count,
                            from.position + (to.position - from.position) * (k / count),
                            from.rotation + (to.rotation - from.rotation) * (k / count)});
    }
    keys.push_back(steps.back());
    return keys;
}

absl::StatusOr<CameraPath> eqPlyPath(const Rows& rows, const Scene& scene) {
    const Mat3 model = turned(vectorAt(rows[0], 0) * (std::numbers::pi / 180));
    ASSIGN_OR_RETURN(const std::vector<Step> steps, sampled(stepsOf(rows)));
    const Vec3 size = scene.bounds.size();
    const double half = orOne(std::max({size.x, size.y, size.z}) / 2);
    CameraPath path;
    path.note = fmt::format("An eqPly path, at {} frames a second, the scene as its model",
                            kPathFramesPerSecond);
    for (const Step& step : steps) {
        // view = rotation * (model * world + position), so the way back is of the transposed.
        const Mat3 worldFromView = glm::transpose(turned(step.rotation) * model);
        const Vec3 eye = glm::transpose(model) * step.position * -half;
        path.flight.keys.push_back(
            {(step.frame - steps.front().frame) / kPathFramesPerSecond,
             scene.lookingAlong(scene.bounds.centre() + eye, worldFromView * Vec3(0, 0, -1),
                                worldFromView * Vec3(0, 1, 0))});
    }
    return path;
}

/// The normal points at the eye or away from it, as programs had it: whichever sees the scene.
bool pointAhead(const Rows& rows, const Vec3& centre) {
    int votes = 0;
    for (std::size_t i = 0; i < rows.count(); ++i) {
        const double towards = glm::dot(vectorAt(rows[i], 6), centre - vectorAt(rows[i], 0));
        votes += (towards > 0 ? 1 : 0) - (towards < 0 ? 1 : 0);
    }
    return votes > 0;
}

absl::StatusOr<CameraPath> normalsPath(const Rows& rows, const Scene& scene) {
    if (rows.count() > kMostPathKeys)
        return tooManyKeys();
    const bool isAhead = pointAhead(rows, scene.bounds.centre());
    CameraPath path;
    path.note = fmt::format("Eyes, ups and normals, at {} frames a second; the normals point {}",
                            kPathFramesPerSecond, isAhead ? "ahead" : "at the eye");
    for (std::size_t i = 0; i < rows.count(); ++i) {
        const Vec3 normal = vectorAt(rows[i], 6);
        path.flight.keys.push_back(
            {static_cast<double>(i) / kPathFramesPerSecond,
             scene.lookingAlong(vectorAt(rows[i], 0), isAhead ? normal : -normal,
                                vectorAt(rows[i], 3))});
    }
    return path;
}

bool haveNumbers(const Rows& rows, std::size_t first, std::size_t numbers) {
    for (std::size_t i = first; i < rows.count(); ++i)
        if (rows[i].size() != numbers)
            return false;
    return true;
}

}  // namespace

absl::StatusOr<CameraPath> cameraPathFromText(std::string_view text, const Box& bounds,
                                              double fovYDegrees) {
    ASSIGN_OR_RETURN(const Rows rows, rowsOf(text));
    const Scene scene{bounds, fovYDegrees};
    const bool isEqPly =
        rows.count() >= 2 && rows[0].size() == kModelNumbers && haveNumbers(rows, 1, kStepNumbers);
    if (!isEqPly && (rows.count() < 2 || !haveNumbers(rows, 0, kCameraNumbers)))
        return absl::InvalidArgumentError(
            "a path has a line of 3 numbers and then lines of 7 (eqPly), or lines of 9 (eye, up, "
            "normal)");
    ASSIGN_OR_RETURN(CameraPath path, isEqPly ? eqPlyPath(rows, scene) : normalsPath(rows, scene));
    RETURN_IF_ERROR(validate(path.flight));
    return path;
}

}  // namespace eyrie::fabric
