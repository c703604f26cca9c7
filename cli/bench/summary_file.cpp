// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/summary_file.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "access/printable.h"
#include "cli/text_file.h"
#include "fabric/status.h"

namespace eyrie::cli::bench {
namespace {

using google::protobuf::Value;

/// A JSON value, and where it is. The first field that is amiss is kept in `problem`.
class Field {
public:
    Field(const Value& value, std::string path, absl::Status& problem)
        : value_(&value), path_(std::move(path)), problem_(&problem) {}

    bool has(const std::string& name) const {
        return value_->struct_value().fields().contains(name);
    }
    Field at(const std::string& name) const {
        const auto& fields = value_->struct_value().fields();
        const auto found = fields.find(name);
        const std::string path = path_.empty() ? name : path_ + "." + name;
        return {found == fields.end() ? none() : found->second, path, *problem_};
    }
    std::vector<Field> list() const {
        expect(Value::kListValue, "a list");
        std::vector<Field> fields;
        for (const Value& value : value_->list_value().values())
            fields.emplace_back(value, fmt::format("{}[{}]", path_, fields.size()), *problem_);
        return fields;
    }
    std::string text() const {
        expect(Value::kStringValue, "a text");
        return access::printableUtf8(value_->string_value());  // whoever wrote the file
    }
    /// At least 0. What is infinite is a string, or null, which earlier reports have for it.
    double number() const {
        if (value_ != &none() && (value_->has_null_value() || value_->string_value() == "Infinity"))
            return std::numeric_limits<double>::infinity();
        expect(Value::kNumberValue, "a number");
        if (!(value_->number_value() >= 0))
            say(fmt::format("{} is {}; expected at least 0", path_, value_->number_value()));
        return value_->number_value();
    }
    int count() const {
        const double value = number();
        if (value != std::floor(value) || value > 1e9)
            say(fmt::format("{} is {}; expected a whole number up to 1e9", path_, value));
        return problem_->ok() ? static_cast<int>(value) : 0;
    }

private:
    static const Value& none() {
        static const Value kNone;
        return kNone;
    }
    void expect(Value::KindCase kind, const char* what) const {
        if (value_->kind_case() == Value::KIND_NOT_SET)
            say(fmt::format("{} is missing; expected {}", path_, what));
        else if (value_->kind_case() != kind)
            say(fmt::format("{} is not {}", path_, what));
    }
    void say(const std::string& what) const {
        if (problem_->ok())
            *problem_ = absl::InvalidArgumentError(what);
    }

    const Value* value_;
    std::string path_;
    absl::Status* problem_;
};

Percentiles percentilesOf(const Field& field) {
    return {field.at("p50").number(), field.at("p95").number(), field.at("p99").number(),
            field.at("max").number()};
}

void readPass(const Field& field, WrittenRun& run) {
    PassSummary pass{.frame = percentilesOf(field)};
    if (field.has("tauP95")) {
        pass.tauP95 = field.at("tauP95").number();
        pass.triangles = field.at("triangles").number();
        pass.points = field.at("points").number();
    } else {
        run.passesTellDrawn = false;
    }
    run.passes.push_back(pass);
}

WrittenRun runOf(const Field& field) {
    WrittenRun run;
    run.label = field.at("label").text();
    run.tauPixels = field.at("tau").number();
    run.renderers = field.at("renderers").count();
    run.compound = field.at("compound").text();
    if (field.has("framesInFlight"))
        run.framesInFlight = field.at("framesInFlight").count();
    run.frame = percentilesOf(field.at("frameMs"));
    for (const Field& pass : field.at("passes").list()) readPass(pass, run);
    run.firstPassMedian = field.at("firstPassMs").at("p50").number();
    run.trianglesMean = field.at("trianglesMean").number();
    if (field.has("pointsMean"))
        run.pointsMean = field.at("pointsMean").number();
    run.tauAchievedMax = field.at("tauAchievedMax").number();
    if (field.has("budgetMs")) {
        run.budgetMilliseconds = field.at("budgetMs").number();
        run.tauAchieved = percentilesOf(field.at("tauAchieved"));
    }
    run.framesBeyond = field.at("framesBeyondTau").number();
    run.bytesLoaded = field.at("bytesLoaded").number();
    run.peakResidentBytes = field.at("peakResidentBytes").number();
    if (field.has("errorPx")) {
        run.errorP99 = field.at("errorPx").at("p99").number();
        run.errorMax = field.at("errorPx").at("max").number();
        if (field.has("framesJudged"))
            run.framesJudged = field.at("framesJudged").count();
    }
    return run;
}

WrittenReport reportOf(const Field& field) {
    const Field bench = field.at("bench");
    WrittenReport report;
    report.scene = bench.at("scene").text();
    report.flight = bench.at("flight").text();
    report.width = bench.at("width").count();
    report.height = bench.at("height").count();
    report.frames = bench.at("frames").count();
    report.command = bench.at("command").text();
    report.occlusion = bench.at("occlusion").text();
    if (bench.has("seen"))
        report.seen = bench.at("seen").text();
    if (bench.has("flightHash"))
        report.flightHash = bench.at("flightHash").text();
    if (bench.has("sceneHash"))
        report.sceneHash = bench.at("sceneHash").text();
    if (bench.has("configurationHash"))
        report.configurationHash = bench.at("configurationHash").text();
    const Field machine = field.at("machine");
    report.processor = machine.at("processor").text();
    report.cores = machine.at("cores").count();
    report.device = machine.at("device").text();
    report.driver = machine.at("driver").text();
    for (const Field& run : field.at("runs").list()) report.runs.push_back(runOf(run));
    return report;
}

}  // namespace

bool isSummary(const std::string& file) {
    const auto text = readText(file);
    Value value;
    if (!text.ok() || !google::protobuf::util::JsonStringToMessage(*text, &value).ok())
        return false;
    absl::Status ignored;
    const Field summary(value, "", ignored);
    return summary.at("bench").has("scene") && summary.has("runs");
}

absl::StatusOr<WrittenReport> readReport(const std::string& path) {
    std::error_code error;  // what cannot be read is said below
    const std::string file =
        std::filesystem::is_directory(path, error) ? path + "/summary.json" : path;
    ASSIGN_OR_RETURN(const std::string text, readText(file));
    Value value;
    const auto parsed = google::protobuf::util::JsonStringToMessage(text, &value);
    if (!parsed.ok())
        return absl::InvalidArgumentError(fmt::format("{}: this is no summary of eyrie bench: {}",
                                                      file, std::string(parsed.message())));
    absl::Status problem;
    WrittenReport report = reportOf(Field(value, "", problem));
    report.name = path;
    if (!problem.ok())
        return fabric::withContext(problem, file);
    return report;
}

}  // namespace eyrie::cli::bench
