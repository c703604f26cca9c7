// SPDX-License-Identifier: Apache-2.0
#include "wire/protocol.h"

#include <set>
#include <string>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <xxhash.h>

#include "eyrie/v1/registry_service.pb.h"
#include "eyrie/v1/render_service.pb.h"

namespace eyrie::wire {
namespace {

using google::protobuf::FileDescriptor;

void collect(const FileDescriptor& file, std::set<std::string>& descriptions) {
    google::protobuf::FileDescriptorProto description;
    file.CopyTo(&description);
    if (!descriptions.insert(description.SerializeAsString()).second)
        return;
    for (int i = 0; i < file.dependency_count(); ++i) collect(*file.dependency(i), descriptions);
}

}  // namespace

std::uint64_t protocolChecksum(std::uint64_t pictureVersion) {
    std::set<std::string> descriptions;
    collect(*v1::RegisterRendererRequest::descriptor()->file(), descriptions);
    collect(*v1::OpenSceneRequest::descriptor()->file(), descriptions);
    std::uint64_t sum = pictureVersion;
    for (const std::string& description : descriptions)
        sum = XXH64(description.data(), description.size(), sum);
    return sum;
}

}  // namespace eyrie::wire
