// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <map>
#include <string_view>
#include <utility>

#include <absl/status/statusor.h>

#include "fabric/vec.h"
#include "renderer/draw/drawable.h"
#include "renderer/gl/program.h"

namespace eyrie::draw {

/// What a program is compiled for. Software renderers pay in every pixel for a light the scene does
/// not have, a branch not taken and a rotation that the lights could have been given once.
struct Variant {
    int lights = 1;         ///< a scene without lights has one that shines from the camera
    bool flat = false;      ///< one normal a triangle
    bool conformal = true;  ///< the object is turned and scaled evenly: lit along its own axes

    auto operator<=>(const Variant&) const = default;
};

Variant variantFor(const FrameState& frame, const fabric::Mat4& worldFromObject);

/// A linked program with the uniforms that every kind of object has: where its lattice lies in the
/// view, and the lights of effects/lighting.glsl.
class ObjectProgram {
public:
    /// Compiles the two sources for `variant`. Internal, with the driver's log, when it fails.
    static absl::StatusOr<ObjectProgram> create(const gl::ShaderSource& vertex,
                                                const gl::ShaderSource& fragment, Variant variant);

    /// Puts the program in use for an object whose vertices lie on a lattice.
    void use(const FrameState& frame, const fabric::Mat4& worldFromObject,
             const fabric::Mat4& objectFromLattice) const;

    GLint uniform(const char* name) const { return program_.uniform(name); }

private:
    explicit ObjectProgram(gl::Program program);
    void setLights(const FrameState& frame, const fabric::Mat3& shadingFromWorld) const;

    gl::Program program_;
    GLint clipFromLattice_;
    GLint metresFromLattice_;
    GLint worldFromNormal_;
    GLint cameraLattice_;
    GLint cameraOffsetMetres_;
    GLint lightDirections_;
    GLint lightColours_;
    GLint ambient_;
};

/// The variants of one kind of program, each compiled when a frame first needs it. `Program` has
/// `static absl::StatusOr<Program> create(Variant)`.
template <typename Program>
class Variants {
public:
    absl::StatusOr<const Program*> find(Variant variant) {
        const auto known = programs_.find(variant);
        if (known != programs_.end())
            return &known->second;
        absl::StatusOr<Program> program = Program::create(variant);
        if (!program.ok())
            return program.status();
        return &programs_.emplace(variant, *std::move(program)).first->second;
    }

private:
    std::map<Variant, Program> programs_;
};

}  // namespace eyrie::draw
