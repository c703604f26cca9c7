# SPDX-License-Identifier: Apache-2.0
add_library(eyrie_http http/access.cpp http/api_calls.cpp http/crowd.cpp http/event_stream.cpp http/http_session.cpp
                       http/late_close.cpp http/observe_routes.cpp http/origin.cpp http/peer.cpp http/probe.cpp http/problem.cpp
                       http/reply.cpp http/request.cpp http/request_target.cpp http/router.cpp http/server.cpp
                       http/static_files.cpp http/status_json.cpp http/tls.cpp http/web_socket.cpp)
add_library(eyrie::http ALIAS eyrie_http)
target_link_libraries(eyrie_http PUBLIC eyrie::access eyrie::fabric eyrie::observe absl::statusor
                                 PRIVATE eyrie::api eyrie::stream Boost::headers OpenSSL::SSL Threads::Threads fmt::fmt)
# The thread sanitizer does not know the fences in Asio and says so; the locks beside them order the
# same accesses.
if(EYRIE_SANITIZE MATCHES thread)
    target_compile_options(eyrie_http PRIVATE -Wno-tsan)
endif()
