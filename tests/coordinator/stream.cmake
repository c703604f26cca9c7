# SPDX-License-Identifier: Apache-2.0
eyrie_test(jpeg_test LABEL unit SOURCES jpeg_test.cpp png_test.cpp LINK eyrie::jpeg eyrie::png PNG::PNG)
eyrie_test(viewer_test LABEL unit
           SOURCES encoded_tiles_test.cpp encoding_test.cpp home_camera_test.cpp link_test.cpp pacer_test.cpp
                   session_fairness_test.cpp session_programs_test.cpp session_test.cpp statistics_feed_test.cpp
                   swap_barrier_test.cpp
                   swap_group_test.cpp video_streams_test.cpp viewer_pick_test.cpp
                   viewer_test.cpp viewer_view_test.cpp
           LINK eyrie::stream eyrie::jpeg eyrie::png eyrie::proto)
eyrie_test(shared_session_test LABEL unit LINK eyrie::http eyrie::test_viewer)
eyrie_test(http_server_test LABEL unit
           SOURCES http_server_test.cpp origin_test.cpp probe_test.cpp request_target_test.cpp viewer_connection_test.cpp
           LINK eyrie::http eyrie::jpeg eyrie::proto Boost::headers Threads::Threads)
eyrie_test(http_access_test LABEL unit SOURCES http_access_test.cpp http_limits_test.cpp https_test.cpp
           LINK eyrie::http eyrie::jpeg eyrie::test_certificates Boost::headers OpenSSL::SSL Threads::Threads)
if(EYRIE_SANITIZE MATCHES thread)
    target_compile_options(http_server_test PRIVATE -Wno-tsan)  # as in coordinator/http.cmake
    target_compile_options(http_access_test PRIVATE -Wno-tsan)
endif()
eyrie_test(api_test LABEL unit SOURCES api_bench_test.cpp api_change_test.cpp api_data_test.cpp api_flight_test.cpp api_grpc_test.cpp api_image_test.cpp api_quota_test.cpp api_session_test.cpp api_test.cpp api_trouble_test.cpp api_untaken_test.cpp
                   operations_test.cpp
           LINK eyrie::api eyrie::frame eyrie::jpeg eyrie::wire eyrie::proto fmt::fmt spdlog::spdlog)
eyrie_test(http_api_test LABEL unit LINK eyrie::http eyrie::api eyrie::proto eyrie::wire Boost::headers Threads::Threads
                                         fmt::fmt)
if(EYRIE_SANITIZE MATCHES thread)
    target_compile_options(http_api_test PRIVATE -Wno-tsan)
endif()
