// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Range asymmetric numeral systems (J. Duda, "Asymmetric numeral systems", 2013; the interleaving
/// of states in one stream: F. Giesen, "Interleaved entropy coders", 2014): 32-bit states, renewed
/// by 16 bits at a time.
namespace eyrie::codec {

inline constexpr std::uint32_t kRansLow = 1U << 16;

/// A symbol's share of the 2^bits that all symbols have.
struct Share {
    std::uint32_t start = 0;
    std::uint32_t size = 1;
};

/// A share of 2^kBits made ready for many symbols. Division by its size is a product and a shift
/// (T. Granlund, P. Montgomery, "Division by invariant integers using multiplication", 1994), exact
/// for the states that are divided: those below `limit`.
template <int kBits>
struct ReadyShare {
    ReadyShare() = default;
    explicit ReadyShare(Share share) : ReadyShare(share, reciprocalOf(share.size)) {}
    ReadyShare(Share share, std::uint64_t reciprocalOfSize)
        : reciprocal(reciprocalOfSize),
          limit(std::uint64_t{share.size} << (32 - kBits)),
          start(share.start),
          others((1U << kBits) - share.size) {}

    static constexpr std::uint64_t reciprocalOf(std::uint32_t size) {
        return ((std::uint64_t{1} << (32 + kBits)) + size - 1) / size;
    }
    std::uint32_t quotient(std::uint32_t x) const {
        return static_cast<std::uint32_t>(x * reciprocal >> (32 + kBits));
    }

    std::uint64_t reciprocal = 0;  ///< 2^(32 + kBits) / size, rounded up
    std::uint64_t limit = 0;       ///< states from here on are renewed first
    std::uint32_t start = 0;
    std::uint32_t others = 0;  ///< what the other symbols have
};

/// Reciprocals of all sizes of shares of 2^kBits, for symbols whose shares keep changing.
template <int kBits>
inline constexpr auto kReciprocals = [] {
    std::array<std::uint64_t, std::size_t{1} << kBits> all{};
    for (std::uint32_t size = 1; size < all.size(); ++size)
        all[size] = ReadyShare<kBits>::reciprocalOf(size);
    return all;
}();

/// A decoder's slot in 32 bits: bits 0-7 the symbol, 8-19 its share, 20-31 the slot's
/// place within the share.
struct SlotEntry {
    std::uint32_t bits = 0;

    std::uint32_t symbol() const { return bits & 0xff; }
    std::uint32_t size() const { return bits >> 8 & 0xfff; }
    std::uint32_t place() const { return bits >> 20; }
};

/// Encodes backwards: give it the symbols from the last to the first.
template <std::size_t kStates>
class RansEncoder {
public:
    RansEncoder() { states_.fill(kRansLow); }

    void put(std::size_t state, Share share, int bits) {
        std::uint32_t& x = states_[state];
        if (x >= std::uint64_t{share.size} << (32 - bits)) {
            words_.push_back(static_cast<std::uint16_t>(x));
            x >>= 16;
        }
        x = (x / share.size << bits) + x % share.size + share.start;
    }

    /// The same, of a symbol put many times.
    template <int kBits>
    void put(std::size_t state, const ReadyShare<kBits>& share) {
        std::uint32_t x = states_[state];
        if (x >= share.limit) {
            words_.push_back(static_cast<std::uint16_t>(x));
            x >>= 16;
        }
        states_[state] = x + share.start + share.quotient(x) * share.others;
    }

    std::vector<std::uint16_t> finish() && {
        for (std::size_t k = kStates; k-- > 0;) {
            words_.push_back(static_cast<std::uint16_t>(states_[k]));
            words_.push_back(static_cast<std::uint16_t>(states_[k] >> 16));
        }
        return {words_.rbegin(), words_.rend()};
    }

private:
    std::array<std::uint32_t, kStates> states_{};
    std::vector<std::uint16_t> words_;
};

/// Decodes forwards. Past the end it reads zeros; isAtEnd() then never becomes true.
template <std::size_t kStates>
class RansDecoder {
public:
    explicit RansDecoder(std::span<const std::uint16_t> words)
        : next_(words.data()), end_(words.data() + words.size()) {
        for (std::uint32_t& x : states_) {
            x = std::uint32_t{word()} << 16;
            x |= word();
        }
    }

    std::uint32_t slot(std::size_t state, int bits) const {
        return states_[state] & ((1U << bits) - 1);
    }

    /// Takes the symbol of that share: the one that holds slot().
    void take(std::size_t state, Share share, int bits) {
        std::uint32_t& x = states_[state];
        x = share.size * (x >> bits) + (x & ((1U << bits) - 1)) - share.start;
        if (x < kRansLow)
            x = x << 16 | word();
    }

    /// The same for a decoder's slot looked up.
    void take(std::size_t state, SlotEntry entry, int bits) {
        std::uint32_t& x = states_[state];
        x = entry.size() * (x >> bits) + entry.place();
        if (x < kRansLow)
            x = x << 16 | word();
    }

    /// Takes `count` symbols, the k-th from state k % kStates and from slots[contexts[k] << kBits]
    /// on, whose entries are SlotEntry's bits.
    template <int kBits>
    void takeRow(const std::uint32_t* slots, const std::uint8_t* contexts, std::size_t count,
                 std::uint8_t* symbols) {
        if (static_cast<std::size_t>(end_ - next_) < count + 1) {
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t at = std::size_t{contexts[k]} << kBits;
                const SlotEntry entry{slots[at + slot(k % kStates, kBits)]};
                take(k % kStates, entry, kBits);
                symbols[k] = static_cast<std::uint8_t>(entry.symbol());
            }
            return;
        }
        // No symbol takes more than one word: without a check and without a branch.
        std::array<std::uint32_t, kStates> states = states_;
        const std::uint16_t* next = next_;
        const auto one = [&](std::size_t k, std::uint32_t& x) {
            const SlotEntry entry{
                slots[(std::size_t{contexts[k]} << kBits) + (x & ((1U << kBits) - 1))]};
            symbols[k] = static_cast<std::uint8_t>(entry.symbol());
            x = entry.size() * (x >> kBits) + entry.place();
            const std::uint32_t isLow = x < kRansLow ? 1 : 0;
            x = x << (16 * isLow) | (*next & (0 - isLow));
            next += isLow;
        };
        std::size_t k = 0;
        for (; k + kStates <= count; k += kStates)
            for (std::size_t state = 0; state < kStates; ++state) one(k + state, states[state]);
        for (std::size_t state = 0; state + 1 < kStates; ++state)
            if (k + state < count)
                one(k + state, states[state]);
        states_ = states;
        next_ = next;
    }

    /// Whether every symbol and every word was taken, as the encoder left them.
    bool isAtEnd() const {
        for (const std::uint32_t x : states_)
            if (x != kRansLow)
                return false;
        return next_ == end_ && !isPastEnd_;
    }
    bool isPastEnd() const { return isPastEnd_; }

private:
    std::uint16_t word() {
        if (next_ != end_) [[likely]]
            return *next_++;
        isPastEnd_ = true;
        return 0;
    }

    const std::uint16_t* next_;
    const std::uint16_t* end_;
    std::array<std::uint32_t, kStates> states_{};
    bool isPastEnd_ = false;
};

/// The probability of a flag, learnt from those before it.
class AdaptiveFlag {
public:
    static constexpr int kBits = 12;

    std::uint32_t ones() const { return ones_; }  ///< of 2^kBits
    Share share(bool flag) const {
        return flag ? Share{0, ones_} : Share{ones_, (1U << kBits) - ones_};
    }
    void learn(bool flag) {
        const int target = flag ? 1 << kBits : 0;
        // Rounds towards where it is: neither probability ever becomes 0.
        ones_ = static_cast<std::uint16_t>(ones_ + (target - ones_) / kSlowness);
    }

private:
    static constexpr int kSlowness = 32;
    std::uint16_t ones_ = 1U << (kBits - 1);
};

}  // namespace eyrie::codec
