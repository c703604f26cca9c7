// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// What a raster may be called: a file by its path, or what GDAL finds in one, by a name with the
/// file's path between colons or quotes, such as GPKG:heights.gpkg:alps or NETCDF:"a.nc":elevation.
namespace eyrie::import {

/// Whether there is a file of this name, or one within it.
bool isThere(const std::string& name);

/// The name with which it is found from any folder.
std::string absoluteName(const std::string& name);

/// What of its file it names, wherever that lies; empty for a whole file.
std::string partOfFile(const std::string& name);

}  // namespace eyrie::import
