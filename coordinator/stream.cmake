# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_stream
    stream/drawing.cpp stream/home_camera.cpp stream/link_estimate.cpp stream/outbox.cpp
    stream/pacer.cpp stream/pick_desk.cpp stream/picture_encoder.cpp stream/profile.cpp
    stream/progress.cpp stream/quality.cpp stream/seat.cpp stream/session.cpp
    stream/session_book.cpp stream/session_drawing.cpp stream/session_people.cpp
    stream/session_serving.cpp stream/session_swaps.cpp stream/sessions.cpp stream/shrink.cpp
    stream/statistics_feed.cpp stream/statistics_message.cpp stream/swap_barrier.cpp
    stream/swap_group.cpp stream/video_streams.cpp stream/view_message.cpp stream/viewer.cpp
    stream/viewer_messages.cpp)
add_library(eyrie::stream ALIAS eyrie_stream)
target_link_libraries(eyrie_stream PUBLIC eyrie::fabric eyrie::observe eyrie::video absl::status
                                   PRIVATE eyrie::jpeg eyrie::png eyrie::wire eyrie::proto
                                           Threads::Threads fmt::fmt
                                           spdlog::spdlog)
