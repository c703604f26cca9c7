// SPDX-License-Identifier: Apache-2.0
#include "wire/look.h"

#include <cstddef>
#include <limits>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "eyrie/v1/look.pb.h"
#include "wire/json.h"

namespace eyrie::wire {
namespace {

double share() { return *rc::gen::inRange(0, 1001) / 1000.0; }
bool coin() { return *rc::gen::arbitrary<bool>(); }

fabric::TransferFunction anyTransfer() {
    fabric::TransferFunction function;
    function.unit = *rc::gen::element(fabric::HeightUnit::Relative, fabric::HeightUnit::Metres);
    const int count = *rc::gen::inRange(0, 5);
    for (int i = 0; i < count; ++i)
        function.primitives.push_back(
            {*rc::gen::element(fabric::PrimitiveShape::Blend, fabric::PrimitiveShape::Box,
                               fabric::PrimitiveShape::Tent, fabric::PrimitiveShape::Smooth),
             9000 * share() - 500,
             0.01 + share(),
             {share(), share(), share()},
             share()});
    return function;
}

fabric::ObjectLook anyObjectLook(std::int32_t object) {
    fabric::ObjectLook look{object};
    if (coin())
        look.colour = fabric::Vec3(share(), share(), share());
    if (coin())
        look.shading = *rc::gen::element(fabric::Shading::Smooth, fabric::Shading::Gouraud,
                                         fabric::Shading::Flat, fabric::Shading::Wireframe);
    return look;
}

fabric::Look anyLook() {
    fabric::Look look;
    look.exaggeration = 2000 * share() - 1000;
    if (coin())
        look.transfer = anyTransfer();
    look.slopeShading = share();
    if (coin())
        look.contours = fabric::ContourLines{0.001 + 1000 * share(), 0.25 + share()};
    look.saturation = 2 * share();
    look.tileBounds = coin();
    look.pageBounds = coin();
    look.levelTint = coin();
    look.rangeTint = coin();
    if (coin())
        look.cutCamera = fabric::Camera{.eye = {share(), 2, 3}, .target = {4, 5, 6}};
    if (coin())
        look.sun = fabric::Sun{720 * share() - 360, 180 * share() - 90};
    for (std::int32_t object = 0; object < 5; ++object)
        if (coin())
            look.hidden.positions.push_back(object);
    for (std::int32_t object = 0; object < 5; ++object)
        if (coin())
            look.objects.looks.push_back(anyObjectLook(object));
    return look;
}

RC_GTEST_PROP(WireLook, ComesBackAsItWas, ()) {
    const fabric::Look look = anyLook();
    RC_ASSERT(fromMessage(toMessage(look)).value() == look);
    RC_ASSERT(lookFromJson(toJson(toMessage(look)), "look.json").value() == look);
}

TEST(WireLook, OfNothingIsTheDefault) {
    EXPECT_EQ(fromMessage(v1::Look()).value(), fabric::Look());
    EXPECT_EQ(lookFromJson("{}", "look.json").value(), fabric::Look());
}

TEST(WireLook, HiddenObjectsComeInAnyOrderButNotInAnyNumber) {
    v1::Look message;
    for (const std::int32_t object : {4, 1, 4, 0}) message.add_hidden_objects(object);
    EXPECT_EQ(fromMessage(message)->hidden.positions, (std::vector<std::int32_t>{0, 1, 4}));
    for (std::int32_t i = 0; i < fabric::kMaxHiddenObjects; ++i) message.add_hidden_objects(i);
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
}

TEST(WireLook, LooksOfObjectsComeInAnyOrder) {
    v1::Look message;
    for (const std::int32_t object : {4, 1, 9}) message.add_objects()->set_object(object);
    const fabric::Look look = fromMessage(message).value();
    EXPECT_EQ(look.objects.of(4), &look.objects.looks[1]);
    EXPECT_EQ(look.objects.of(5), nullptr);
    EXPECT_EQ(look.objects.of(std::numeric_limits<std::size_t>::max()), nullptr);
    while (message.objects_size() <= fabric::kMaxObjectLooks)
        message.add_objects()->set_object(100 + message.objects_size());
    EXPECT_TRUE(absl::IsInvalidArgument(fromMessage(message).status()));
}

TEST(WireLook, ARefusalNamesFileAndField) {
    const auto refusal = [](const char* text) {
        return std::string(lookFromJson(text, "odd.json").status().message());
    };
    using testing::AllOf;
    using testing::HasSubstr;
    EXPECT_THAT(refusal(R"({"exaggeration":1001})"),
                AllOf(HasSubstr("odd.json"), HasSubstr("look.exaggeration is 1001"),
                      HasSubstr("from -1000 to 1000")));
    EXPECT_THAT(refusal(R"({"exaggeration":"NaN"})"), HasSubstr("look.exaggeration is nan"));
    EXPECT_THAT(refusal(R"({"saturation":2.5})"), HasSubstr("look.saturation"));
    EXPECT_THAT(refusal(R"({"slopeShading":-1})"), HasSubstr("look.slopeShading"));
    EXPECT_THAT(refusal(R"({"contours":{}})"), HasSubstr("look.contours.intervalMetres is 0"));
    EXPECT_THAT(refusal(R"({"contours":{"intervalMetres":10,"widthPixels":99}})"),
                HasSubstr("look.contours.widthPixels"));
    EXPECT_THAT(refusal(R"({"transfer":{"primitives":[{"width":1}]}})"),
                HasSubstr("look.transfer.primitives[0].colour has 0 numbers"));
    EXPECT_THAT(refusal(R"({"transfer":{"primitives":[{"shape":9}]}})"),
                HasSubstr("look.transfer.primitives[0].shape is 9"));
    EXPECT_THAT(refusal(R"({"transfer":{"unit":7}})"), HasSubstr("look.transfer.unit is 7"));
    EXPECT_THAT(refusal(R"({"cutCamera":{"eye":[0,0,0],"target":[0,0,0]}})"),
                HasSubstr("look.cutCamera: camera.target"));
    EXPECT_THAT(refusal(R"({"sun":{"azimuthDegrees":361}})"),
                HasSubstr("look.sun.azimuthDegrees is 361"));
    EXPECT_THAT(refusal(R"({"sun":{"elevationDegrees":"NaN"}})"),
                HasSubstr("look.sun.elevationDegrees is nan"));
    EXPECT_THAT(refusal(R"({"hiddenObjects":[3,-2]})"),
                HasSubstr("look.hiddenObjects has object -2"));
    EXPECT_THAT(refusal(R"({"objects":[{},{"object":-1}]})"),
                HasSubstr("look.objects[1].object is -1"));
    EXPECT_THAT(refusal(R"({"objects":[{"object":3},{"object":3}]})"),
                HasSubstr("look.objects has object 3 twice"));
    EXPECT_THAT(refusal(R"({"objects":[{"colour":[0,1]}]})"),
                HasSubstr("look.objects[0].colour has 2 numbers"));
    EXPECT_THAT(refusal(R"({"objects":[{"colour":[0,1,1.5]}]})"),
                HasSubstr("look.objects[0].colour[2] is 1.5"));
    EXPECT_THAT(refusal(R"({"objects":[{"colour":[0,1,"NaN"]}]})"),
                HasSubstr("look.objects[0].colour[2] is nan"));
    EXPECT_THAT(refusal(R"({"objects":[{"shading":17}]})"),
                HasSubstr("look.objects[0].shading is 17"));
    EXPECT_THAT(refusal(R"({"exageration":2})"), HasSubstr("exageration"));
}

}  // namespace
}  // namespace eyrie::wire
