// SPDX-License-Identifier: Apache-2.0
#include "tests/support/certificates.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

namespace eyrie::test {
namespace {

using Key = std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)>;
using Certificate = std::unique_ptr<X509, void (*)(X509*)>;

void expect(bool isDone, const char* what) {
    if (!isDone)
        throw std::runtime_error(what);
}

Key makeKey() { return {EVP_EC_gen("P-256"), EVP_PKEY_free}; }

template <typename Write>
void writeFile(const std::string& path, Write write) {
    const std::string draft = path + ".new";
    FILE* file = std::fopen(draft.c_str(), "w");
    expect(file != nullptr && write(file) == 1, "cannot write a PEM file");
    std::fclose(file);
    chmod(draft.c_str(), 0600);
    std::filesystem::rename(draft, path);  // a reader never sees half of it
}

template <typename Value>
Value readFile(const std::string& path, Value (*read)(FILE*, Value*, pem_password_cb*, void*)) {
    FILE* file = std::fopen(path.c_str(), "r");
    expect(file != nullptr, "cannot read a PEM file");
    Value value = read(file, nullptr, nullptr, nullptr);
    std::fclose(file);
    return value;
}

void addExtension(X509* certificate, X509* issuer, int kind, const std::string& value) {
    X509V3_CTX context;
    X509V3_set_ctx_nodb(&context);
    X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
    X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
    expect(extension != nullptr && X509_add_ext(certificate, extension, -1) == 1,
           "cannot add an extension");
    X509_EXTENSION_free(extension);
}

Certificate makeCertificate(EVP_PKEY* key, const std::string& name, long from, long to) {
    Certificate certificate(X509_new(), X509_free);
    X509_set_version(certificate.get(), 2);
    std::uint32_t serial = 0;
    RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), serial >> 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate.get()), from);
    X509_gmtime_adj(X509_getm_notAfter(certificate.get()), to);
    X509_set_pubkey(certificate.get(), key);
    X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate.get()), "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
    return certificate;
}

bool isAddress(const std::string& name) {
    return name.find_first_not_of("0123456789.") == std::string::npos ||
           name.find(':') != std::string::npos;
}

}  // namespace

Authority::Authority(const std::string& name) : name_(name) {
    const Key key = makeKey();
    const Certificate certificate = makeCertificate(key.get(), name_, -7200, 7200);
    X509_set_issuer_name(certificate.get(), X509_get_subject_name(certificate.get()));
    addExtension(certificate.get(), certificate.get(), NID_basic_constraints, "critical,CA:TRUE");
    addExtension(certificate.get(), certificate.get(), NID_key_usage, "critical,keyCertSign");
    expect(X509_sign(certificate.get(), key.get(), EVP_sha256()) != 0, "cannot sign");
    writeFile(folder_.path("ca.key"), [&](FILE* file) {
        return PEM_write_PrivateKey(file, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
    });
    writeFile(this->file(), [&](FILE* file) { return PEM_write_X509(file, certificate.get()); });
}

access::TlsFiles Authority::issue(const std::string& file, const Holder& holder) const {
    const Key authorityKey(readFile<EVP_PKEY*>(folder_.path("ca.key"), PEM_read_PrivateKey),
                           EVP_PKEY_free);
    const Certificate authority(readFile<X509*>(this->file(), PEM_read_X509), X509_free);
    const Key key = makeKey();
    const Certificate certificate =
        makeCertificate(key.get(), holder.name, holder.validFromSeconds, holder.validToSeconds);
    X509_set_issuer_name(certificate.get(), X509_get_subject_name(authority.get()));
    addExtension(certificate.get(), authority.get(), NID_subject_alt_name,
                 (isAddress(holder.name) ? "IP:" : "DNS:") + holder.name);
    expect(X509_sign(certificate.get(), authorityKey.get(), EVP_sha256()) != 0, "cannot sign");
    const access::TlsFiles files{folder_.path(file + ".crt"), folder_.path(file + ".key"),
                                 this->file()};
    writeFile(files.key, [&](FILE* to) {
        return PEM_write_PrivateKey(to, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
    });
    writeFile(files.certificate, [&](FILE* to) { return PEM_write_X509(to, certificate.get()); });
    return files;
}

}  // namespace eyrie::test
