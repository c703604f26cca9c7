// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/strip_order.h"

#include <algorithm>

namespace eyrie::import {

bool isInStrips(GDALRasterBand& band) {
    int columns = 0, rows = 0;
    band.GetBlockSize(&columns, &rows);
    return columns >= band.GetXSize();
}

std::uint64_t rowBytes(GDALDataset& dataset) {
    std::uint64_t bytes = 1;  // of a mask
    for (int number = 1; number <= dataset.GetRasterCount(); ++number)
        bytes += static_cast<std::uint64_t>(
            GDALGetDataTypeSizeBytes(dataset.GetRasterBand(number)->GetRasterDataType()));
    return bytes * static_cast<std::uint64_t>(dataset.GetRasterXSize());
}

/// What cannot be read is told when it is asked for.
void StripOrder::prepare(int row, int end) {
    if (rows_ == 0)
        return;
    int columns = 0, rows = 0;
    bands_.front()->GetBlockSize(&columns, &rows);
    for (int y = std::max(next_, end - rows_) / rows; y < row / rows; ++y)
        for (GDALRasterBand* band : bands_)
            if (GDALRasterBlock* const block = band->GetLockedBlockRef(0, y))
                block->DropLock();
    next_ = std::max(next_, end);
}

}  // namespace eyrie::import
