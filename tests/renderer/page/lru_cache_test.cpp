// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/lru_cache.h"

#include <string>

#include <gtest/gtest.h>

namespace eyrie::page {
namespace {

TEST(LruCache, DropsWhatWasNotUsedLongestOnceTheLimitIsExceeded) {
    LruCache<int, std::string> cache(100);
    cache.insert(1, "one", 40);
    cache.trim();
    cache.insert(2, "two", 40);
    cache.trim();
    ASSERT_NE(cache.find(1), nullptr);
    cache.insert(3, "three", 40);
    cache.trim();
    EXPECT_EQ(cache.find(2), nullptr);
    ASSERT_NE(cache.find(1), nullptr);
    EXPECT_EQ(*cache.find(1), "one");
    EXPECT_NE(cache.find(3), nullptr);
    EXPECT_EQ(cache.bytes(), 80U);
}

TEST(LruCache, NeverDropsWhatTheCurrentFrameUses) {
    LruCache<int, int> cache(10);
    for (int key = 0; key < 5; ++key) cache.insert(key, key, 10);
    cache.trim();
    EXPECT_EQ(cache.size(), 5U) << "all five were used in this frame";
    ASSERT_NE(cache.find(3), nullptr);
    cache.trim();
    EXPECT_EQ(cache.size(), 1U);
    EXPECT_NE(cache.find(3), nullptr);
}

TEST(LruCache, ReturnsToItsLimitOnceTheLoadIsGone) {
    LruCache<int, int> cache(30);
    for (int key = 0; key < 100; ++key) {
        cache.insert(key, key, 10);
        cache.trim();
        EXPECT_LE(cache.bytes(), 40U);
    }
    EXPECT_EQ(cache.bytes(), 30U);
}

}  // namespace
}  // namespace eyrie::page
