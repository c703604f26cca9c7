// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace eyrie::config {

/// Where something stands in a configuration file: a line and a column, both from 1 on, of a text,
/// a field such as nodes[0].pipes[1].device of a message; neither where there is no file. It is no
/// part of what a configuration means: all places are equal.
struct Place {
    std::size_t line = 0;
    std::size_t column = 0;
    std::string field = {};

    bool operator==(const Place&) const { return true; }
};

struct Finding {
    /// The gravest first.
    enum class Kind {
        Error,     ///< the configuration cannot be used
        Warning,   ///< something in it has no effect, or not the one that was probably meant
        OnScreen,  ///< makes sense on a screen only: accepted, without effect here
        Note       ///< accepted, without effect here; says what has it
    };
    Kind kind = Kind::Error;
    Place place;
    std::string message;
};

/// What is found wrong with a configuration: everything, not the first thing only.
class Findings {
public:
    /// More errors than this say nothing new.
    static constexpr std::size_t kMost = 200;

    void error(const Place& place, std::string message) {
        add(Finding::Kind::Error, place, std::move(message));
    }
    void warning(const Place& place, std::string message) {
        add(Finding::Kind::Warning, place, std::move(message));
    }
    void onScreen(const Place& place, std::string message) {
        add(Finding::Kind::OnScreen, place, std::move(message));
    }

    void note(const Place& place, std::string message) {
        add(Finding::Kind::Note, place, std::move(message));
    }

    bool hasErrors() const { return errors() > 0; }
    std::size_t errors() const { return counts_[0]; }
    /// In the order found; of each kind the first kMost.
    const std::vector<Finding>& all() const { return all_; }

private:
    void add(Finding::Kind kind, const Place& place, std::string message);

    std::vector<Finding> all_;
    std::array<std::size_t, 4> counts_{};  ///< of each kind
};

/// "12:5", or the field; empty where neither is known.
std::string describe(const Place& place);

/// "12:5: error: …", a line each, after `name` and a colon. What has no effect here comes last,
/// once for all places where the same is said. Only of the kinds from the first to the last.
std::string describe(const Findings& findings, const std::string& name,
                     Finding::Kind first = Finding::Kind::Error,
                     Finding::Kind last = Finding::Kind::Note);

}  // namespace eyrie::config
