// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::wire {

class HandshakeLog;

/// Readies the gRPC library for this process, once; later calls do nothing.
///
/// What it would print on standard error goes to our log, at level debug: whatever matters of it
/// comes back as a status, and is told once, in words for people. All but peers that a port
/// refuses, which HandshakeLog finds there, and are warned of. And it stays initialised until the
/// process ends, because the shutdown of gRPC 1.51 after the last server or channel may wait 10
/// seconds for a poller that watches a connection which is gone. Its threads therefore outlive
/// main(): neither the log nor OpenSSL is taken from under them.
void startGrpc();

/// What this process hears of handshakes that fail. Lasts as long as the process.
HandshakeLog& handshakeLog();

}  // namespace eyrie::wire
