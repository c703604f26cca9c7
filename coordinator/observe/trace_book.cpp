// SPDX-License-Identifier: Apache-2.0
// The form is Google's "Trace Event Format" (2016): complete events, and metadata that name
// processes and threads.
#include "coordinator/observe/trace_book.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "fabric/json_text.h"

namespace eyrie::observe {
namespace {

double microseconds(Clock::duration time) {
    return std::chrono::duration<double, std::micro>(time).count();
}

/// Processes and threads by number, in the order of their names, the coordinator first.
class Numbers {
public:
    explicit Numbers(const std::vector<Span>& spans) {
        std::set<std::pair<bool, std::string>> processes;
        for (const Span& span : spans) {
            processes.insert({span.process != "coordinator", span.process});
            threads_[{span.process, span.thread}] = 0;
        }
        for (const auto& [isOther, name] : processes)
            processes_[name] = static_cast<int>(processes_.size()) + 1;
        int next = 0;
        for (auto& [thread, number] : threads_) number = ++next;
    }

    int process(const Span& span) const { return processes_.at(span.process); }
    int thread(const Span& span) const { return threads_.at({span.process, span.thread}); }

    void describe(std::string& json) const {
        for (const auto& [name, number] : processes_)
            json += fmt::format(
                R"({{"ph":"M","name":"process_name","pid":{},"tid":0,"args":{{"name":{}}}}},)"
                "\n",
                number, fabric::quotedJson(name));
        for (const auto& [thread, number] : threads_)
            json += fmt::format(
                R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}},)"
                "\n",
                processes_.at(thread.first), number, fabric::quotedJson(thread.second));
    }

private:
    std::map<std::string, int> processes_;
    std::map<std::pair<std::string, std::string>, int> threads_;
};

std::string argumentsOf(const Span& span) {
    std::string json;
    const auto add = [&](std::string_view name, const std::string& value) {
        json += fmt::format("{}\"{}\":{}", json.empty() ? "" : ",", name, value);
    };
    if (span.frame != 0)
        add("frame", fmt::format("{}", span.frame));
    if (span.clockBound)
        add("clockBoundMicroseconds", fmt::format("{:.3f}", microseconds(*span.clockBound)));
    if (!span.note.empty())
        add("note", fabric::quotedJson(span.note));
    return json;
}

/// When the first of the last `frames` frames began.
Clock::time_point beginOf(const std::deque<Span>& spans, std::size_t frames) {
    std::map<std::uint64_t, Clock::time_point> begins;
    for (const Span& span : spans)
        if (span.frame != 0) {
            const auto [known, isNew] = begins.try_emplace(span.frame, span.begin);
            known->second = std::min(known->second, span.begin);
        }
    while (begins.size() > frames) begins.erase(begins.begin());
    return begins.empty() ? Clock::time_point::max() : begins.begin()->second;
}

}  // namespace

std::string rendererName(const std::string& address) {
    constexpr std::string_view kUnix = "unix:";
    if (!address.starts_with(kUnix))
        return address;
    const std::size_t slash = address.rfind('/');
    return address.substr(slash == std::string::npos ? kUnix.size() : slash + 1);
}

void TraceBook::add(Span span) {
    if (span.end < span.begin)
        return;
    const std::lock_guard lock(mutex_);
    spans_.push_back(std::move(span));
    if (spans_.size() > kMaxSpans)
        spans_.pop_front();
}

std::string TraceBook::chromeJson(std::size_t frames) const {
    std::vector<Span> chosen;
    Clock::time_point begin;
    {
        const std::lock_guard lock(mutex_);
        begin = beginOf(spans_, frames);
        for (const Span& span : spans_)
            if (span.begin >= begin)
                chosen.push_back(span);
    }
    // What is within comes after what is around it.
    std::ranges::stable_sort(chosen, [](const Span& a, const Span& b) {
        return a.begin != b.begin ? a.begin < b.begin : a.end > b.end;
    });
    const Numbers numbers(chosen);
    std::string json = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n";
    numbers.describe(json);
    for (const Span& span : chosen)
        json += fmt::format(
            R"({{"ph":"X","name":{},"cat":"frame","pid":{},"tid":{},"ts":{:.3f},"dur":{:.3f},"args":{{{}}}}},)"
            "\n",
            fabric::quotedJson(span.name), numbers.process(span), numbers.thread(span),
            microseconds(span.begin - begin), microseconds(span.end - span.begin),
            argumentsOf(span));
    if (json.ends_with(",\n"))
        json.resize(json.size() - 2);
    return json + "\n]}\n";
}

}  // namespace eyrie::observe
