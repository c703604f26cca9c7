// SPDX-License-Identifier: Apache-2.0
#include "bench/simulator/events.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace eyrie::simulator {

Id Events::addResource(double rate) {
    resources_.push_back({rate});
    return resources_.size() - 1;
}

Id Events::addActivity(double work, double most, std::vector<Id> resources, std::vector<Id> after) {
    const Id id = activities_.size();
    activities_.push_back({work, most, std::move(resources), {}, 0});
    for (const Id before : after) addDependency(id, before);
    return id;
}

Id Events::addDelay(double milliseconds, std::vector<Id> after) {
    return addActivity(milliseconds, 1, {}, std::move(after));
}

void Events::addDependency(Id activity, Id after) {
    activities_[after].next.push_back(activity);
    ++activities_[activity].waitsFor;
}

double Events::rateOf(const Activity& activity) const {
    double rate = activity.most;
    for (const Id id : activity.resources)
        rate = std::min(rate, resources_[id].rate / static_cast<double>(resources_[id].users));
    return rate;
}

void Events::start(Id id) {
    for (const Id resource : activities_[id].resources) ++resources_[resource].users;
    running_.push_back(id);
}

void Events::finish(Id id) {
    Activity& activity = activities_[id];
    activity.done = now_;
    ++finished_;
    for (const Id resource : activity.resources) --resources_[resource].users;
    for (const Id next : activity.next)
        if (--activities_[next].waitsFor == 0)
            start(next);
}

bool Events::run() {
    for (Id id = 0; id < activities_.size(); ++id)
        if (activities_[id].waitsFor == 0)
            start(id);
    while (!running_.empty()) {
        double step = std::numeric_limits<double>::infinity();
        for (const Id id : running_) {
            Activity& activity = activities_[id];
            activity.rate = rateOf(activity);
            step = std::min(step, activity.left / activity.rate);
        }
        now_ += step;
        std::vector<Id> done;
        std::erase_if(running_, [&](Id id) {
            Activity& activity = activities_[id];
            const double work = step * activity.rate;
            for (const Id resource : activity.resources)
                resources_[resource].used += work / resources_[resource].rate;
            activity.left -= work;
            // What ends within a billionth of the step ends with it.
            if (activity.left > 1e-9 * work + 1e-12)
                return false;
            done.push_back(id);
            return true;
        });
        for (const Id id : done) finish(id);
    }
    return finished_ == activities_.size();
}

}  // namespace eyrie::simulator
