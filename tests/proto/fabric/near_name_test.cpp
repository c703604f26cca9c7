// SPDX-License-Identifier: Apache-2.0
#include "fabric/near_name.h"

#include <string>

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

TEST(DidYouMean, ProposesOnlyWhatIsNear) {
    EXPECT_EQ(didYouMean("lisen", {"listen", "quiet"}), ", did you mean 'listen'?");
    EXPECT_EQ(didYouMean("verbosity", {"listen", "quiet"}), "");
    EXPECT_EQ(didYouMean(std::string(1000, 'x'), {"listen"}), "");
}

}  // namespace
}  // namespace eyrie::fabric
