// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <spdlog/spdlog.h>

/// The log, as spdlog has it. Include this, not spdlog's own header: its functions format in place,
/// and fmt 9 would have every source that calls one compile all of formatting anew, which takes ten
/// times as long as the rest of the source under the sanitizers. The library has it already.
#ifndef FMT_HEADER_ONLY
extern template void fmt::detail::vformat_to<char>(buffer<char>&, basic_string_view<char>,
                                                   basic_format_args<buffer_context<char>>,
                                                   locale_ref);
#endif
