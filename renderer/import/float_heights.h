// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <gdal_priv.h>

namespace eyrie::import {

/// The only band of a dataset of our own: heights as floats, of which NaN is nodata.
class FloatHeights : public GDALRasterBand {
public:
    double GetNoDataValue(int* isSet) override {
        if (isSet != nullptr)
            *isSet = 1;
        return std::numeric_limits<double>::quiet_NaN();
    }

protected:
    FloatHeights(GDALDataset* owner, int columns, int rows) {
        constexpr int kBlock = 256;
        poDS = owner;
        nBand = 1;
        eDataType = GDT_Float32;
        nRasterXSize = columns;
        nRasterYSize = rows;
        nBlockXSize = nBlockYSize = kBlock;
    }
};

}  // namespace eyrie::import
