// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

namespace eyrie::terrain {

/// A list whose greatest length is known: appending checks and moves nothing, which a std::vector's
/// push_back does each time. Keeps its memory when cleared.
template <typename T>
class BoundedList {
public:
    explicit BoundedList(std::size_t most) : room_(most) {}

    void push(const T& value) { *grow(1) = value; }
    /// The new last `count` values, not set.
    T* grow(std::size_t count) {
        assert(size_ + count <= room_.size());
        T* const first = room_.data() + size_;
        size_ += count;
        return first;
    }
    void shrink(std::size_t size) { size_ = size; }
    void clear() { size_ = 0; }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* data() { return room_.data(); }
    const T* data() const { return room_.data(); }
    T& operator[](std::size_t k) { return room_[k]; }
    const T& operator[](std::size_t k) const { return room_[k]; }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }

private:
    std::vector<T> room_;
    std::size_t size_ = 0;
};

}  // namespace eyrie::terrain
