// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace eyrie::observe {

using Clock = std::chrono::steady_clock;

/// A short name for the renderer at `address`: "renderer-0-1" of a Unix socket of that name, else
/// the address.
std::string rendererName(const std::string& address);

/// A stretch of work. Those of one thread of a process lie beside or within each other.
struct Span {
    std::string process;  ///< "coordinator", or a renderer's name
    std::string thread;
    std::string name;
    std::uint64_t frame = 0;  ///< that it was for; 0: none in particular
    Clock::time_point begin;  ///< of this process's clock, whoever did it
    Clock::time_point end;
    /// For what another process did: how far its clock may be off.
    std::optional<std::chrono::nanoseconds> clockBound = {};
    std::string note = {};  ///< what became of it, where that is worth a word
};

/// The latest work, span by span, for people who want to know where a frame's time goes. Bounded:
/// the oldest spans go. All functions may be called from any thread.
class TraceBook {
public:
    static constexpr std::size_t kMaxSpans = 32768;

    /// One that ends before it begins is not taken.
    void add(Span span);

    /// The last `frames` frames, and what else was done since the first of them began, in the form
    /// of Chrome's trace viewer, which Perfetto reads, too (JSON object format, "X" events,
    /// microseconds).
    std::string chromeJson(std::size_t frames) const;

private:
    mutable std::mutex mutex_;  ///< guards spans_
    std::deque<Span> spans_;    ///< in the order of their ends, about
};

}  // namespace eyrie::observe
