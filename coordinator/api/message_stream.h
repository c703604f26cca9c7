// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include <absl/status/statusor.h>

namespace google::protobuf {
class Message;
}

namespace eyrie::api {

/// The answer of a call that goes on: messages, one after another, as they are asked for. Any
/// thread may call, one at a time.
class MessageStream {
public:
    using Message = std::shared_ptr<const google::protobuf::Message>;
    using Then = std::function<void(const absl::StatusOr<Message>&)>;

    /// Ends it: afterwards no `then` runs any more.
    virtual ~MessageStream() = default;

    /// Has `then` called once, from any thread and without locks held, when there is a message, or
    /// with why there will be no more. Not before the one before has been called.
    virtual void next(Then then) = 0;
};

}  // namespace eyrie::api
