// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/codec/bits.h"
#include "renderer/codec/rans.h"

namespace eyrie::codec {

inline constexpr int kSymbolBits = 11;
inline constexpr std::uint32_t kAllShares = 1U << kSymbolBits;

/// How often each symbol of one context comes, in shares of kAllShares.
class SymbolShares {
public:
    SymbolShares() = default;
    /// In proportion to `counts`, at least 1 for each symbol that comes at all.
    /// Precondition: fewer than kAllShares symbols.
    explicit SymbolShares(std::span<const std::uint32_t> counts);

    Share of(std::uint32_t symbol) const { return shares_[symbol]; }
    void write(BitWriter& writer) const;
    /// False where the bits hold no shares of at most `symbols` symbols.
    bool read(BitReader& reader, std::uint32_t symbols);

    /// What each of kAllShares slots decodes to, see SlotEntry.
    void fillSlots(std::span<std::uint32_t, kAllShares> slots) const;

private:
    void setSizes(std::span<const std::uint32_t> sizes);

    std::vector<Share> shares_;  // by symbol; empty: no symbol ever comes
};

}  // namespace eyrie::codec
