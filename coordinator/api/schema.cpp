// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/schema.h"

#include <cassert>

#include <google/protobuf/descriptor.pb.h>

#include "api_schema.h"

namespace eyrie::api {
namespace {

const google::protobuf::DescriptorPool& pool() {
    static const auto* const made = [] {
        google::protobuf::FileDescriptorSet files;
        [[maybe_unused]] const bool isRead =
            files.ParseFromArray(kApiSchema, static_cast<int>(sizeof(kApiSchema)));
        assert(isRead);
        auto* const result = new google::protobuf::DescriptorPool;  // lives as long as the program
        for (const auto& file : files.file()) result->BuildFile(file);
        return result;
    }();
    return *made;
}

}  // namespace

const google::protobuf::ServiceDescriptor& documentedService() {
    return *pool().FindServiceByName("eyrie.v1.CoordinatorService");
}

}  // namespace eyrie::api
