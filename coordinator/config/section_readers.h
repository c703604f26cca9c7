// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/configuration.h"
#include "coordinator/config/value_reader.h"

/// The sections of a .eqc file; each reads one block. What they refer to must have been read
/// before.
namespace eyrie::config {

Connection readConnection(const Statement& block, ValueReader& reader);
/// `node` has what is said of it before.
void readNode(const Statement& block, ValueReader& reader, Node& node);

Surface readWall(const Statement& block, ValueReader& reader);
Surface readProjection(const Statement& block, ValueReader& reader);
SwapBarrier readSwapBarrier(const Statement& block, ValueReader& reader);

/// Of eye bases and focus distances: sums of such are exact enough.
inline constexpr double kMostEyeMetres = 1e6;

Observer readObserver(const Statement& block, ValueReader& reader);
Layout readLayout(const Statement& block, const Configuration& before, ValueReader& reader);
Canvas readCanvas(const Statement& block, const Configuration& before, ValueReader& reader);

Compound readCompound(const Statement& block, const Configuration& before, ValueReader& reader);

Equalizer readEqualizer(const Statement& block, EqualizerKind kind, ValueReader& reader);
/// Of the form before 1.0's equalizers: what it balances is its mode. Nothing where that is wrong.
std::optional<Equalizer> readLoadBalancer(const Statement& block, ValueReader& reader);

/// The channel of that name, or at ( node N pipe P window W channel C ), each by name or position;
/// nothing where there is none, an error.
std::optional<ChannelIndex> readChannel(const Statement& statement, const Configuration& before,
                                        ValueReader& reader);
/// Whether it is of the second form, and not of a view's segment.
bool isPosition(const Statement& reference);

}  // namespace eyrie::config
