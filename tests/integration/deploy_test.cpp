// SPDX-License-Identifier: Apache-2.0
// What is in deploy/ fits the program: its options, and its version.
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/support/program.h"
#include "tests/support/source_text.h"

namespace eyrie {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string textOf(const std::string& name) { return test::sourceText("deploy/" + name); }

/// "--listen" and so on; what is said of them in comments counts as well.
std::set<std::string> optionsIn(const std::string& text) {
    const std::regex option("(^|[^-\\w])(--[a-z][a-z-]+[a-z])");
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), option), end; at != end; ++at)
        found.insert((*at)[2]);
    return found;
}

void expectKnown(const std::vector<std::string>& command, const std::string& text,
                 const std::string& place) {
    std::vector<std::string> arguments = command;
    arguments.emplace_back("--help");
    const std::set<std::string> known = optionsIn(test::eyrie(arguments).output);
    const std::set<std::string> used = optionsIn(text);
    ASSERT_THAT(used, Not(IsEmpty())) << place;
    for (const std::string& option : used)
        EXPECT_TRUE(known.contains(option)) << place << " has " << option;
}

std::string definitionOf(const std::string& name) {
    const std::string parts = textOf("helm/eyrie/templates/_parts.tpl");
    const std::size_t begin = parts.find("define \"" + name + "\"");
    EXPECT_NE(begin, std::string::npos) << name;
    return parts.substr(begin, parts.find("{{- define", begin + 1) - begin);
}

TEST(Deploy, ChartsGiveEachCommandOptionsThatItHas) {
    const std::string templates = "helm/eyrie/templates/";
    const std::string access = definitionOf("eyrie.access");
    const std::string certificates = definitionOf("eyrie.certificates");
    expectKnown({"coordinator"}, textOf(templates + "coordinator.yaml") + access + certificates,
                "coordinator.yaml");
    expectKnown({"renderer"}, textOf(templates + "renderers.yaml") + access + certificates,
                "renderers.yaml");
    expectKnown({"health"}, certificates + definitionOf("eyrie.rendererProbe"), "the probe");
    expectKnown({"import", "terrain"}, textOf(templates + "import.yaml"), "import.yaml");
}

/// A pod whose volume is full is evicted.
TEST(Deploy, PodsKeepLessThanTheirCacheHolds) {
    const std::string values = textOf("helm/eyrie/values.yaml");
    const auto gigabytesOf = [&](const std::string& name) {
        std::smatch found;
        EXPECT_TRUE(std::regex_search(values, found, std::regex("\n  " + name + ": (\\d+)Gi?\n")))
            << name;
        return found.empty() ? 0 : std::stoi(found[1]);
    };
    EXPECT_GT(gigabytesOf("keptFromUrls"), 0);
    EXPECT_LT(gigabytesOf("keptFromUrls"), gigabytesOf("cacheSize"));
    for (const char* name : {"coordinator.yaml", "renderers.yaml"})
        EXPECT_THAT(textOf(std::string("helm/eyrie/templates/") + name),
                    HasSubstr("- --cache-size={{ .Values.data.keptFromUrls }}\n"));
}

/// Kubernetes refuses an upgrade that changes the pods of a job of the same name.
TEST(Deploy, ImportsOfOtherPodsHaveAnotherName) {
    const std::string text = textOf("helm/eyrie/templates/import.yaml");
    EXPECT_THAT(text,
                HasSubstr("$name := printf \"%s-import-%s\" .Release.Name (sha256sum $share "));
    EXPECT_THAT(text, HasSubstr("\n  template: {{- $step.pod | nindent 4 }}\n---\n"))
        << "pods have what is not in their name";
    EXPECT_THAT(definitionOf("eyrie.labels"), HasSubstr(".Chart.AppVersion"));
    const std::size_t pod = text.find("define \"eyrie.importPod\"");
    ASSERT_NE(pod, std::string::npos);
    EXPECT_THAT(text.substr(pod, text.find("\n{{- end }}\n", pod) - pod),
                Not(HasSubstr("\"eyrie.labels\"")))
        << "each version imports anew";
}

/// A runtime of NVIDIA that is the node's default gives GPUs by this variable; the image asks for
/// all.
TEST(Deploy, PodsThatAskForNoGpuGetNone) {
    EXPECT_THAT(textOf("Dockerfile"), HasSubstr("NVIDIA_VISIBLE_DEVICES=all"));
    EXPECT_THAT(definitionOf("eyrie.withoutGpu"),
                HasSubstr("- { name: NVIDIA_VISIBLE_DEVICES, value: void }\n"));
    const std::string templates = "helm/eyrie/templates/";
    const std::string without = " env: {{- include \"eyrie.withoutGpu\" . | nindent ";
    EXPECT_THAT(textOf(templates + "coordinator.yaml"), HasSubstr(without));
    EXPECT_THAT(textOf(templates + "import.yaml"), HasSubstr(without));
    EXPECT_THAT(textOf(templates + "renderers.yaml"),
                HasSubstr("{{- if not .Values.renderer.gpu.count }}\n         " + without));
}

TEST(Deploy, ComposeGivesEachCommandOptionsThatItHas) {
    const std::string text = textOf("compose.yaml");
    const std::regex command("command: \\[(\\w+), ([^\\n]*)\\]");
    int commands = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), command), end; at != end; ++at) {
        expectKnown({(*at)[1]}, (*at)[2], "compose.yaml");
        ++commands;
    }
    EXPECT_EQ(commands, 2);
}

/// `eyrie health` asks by TLS where its own environment says so; it sees no other process's
/// options.
TEST(Deploy, ComposeTellsOfTlsByVariablesThatTheHealthCheckReads) {
    const std::string text = textOf("compose.yaml");
    EXPECT_THAT(textOf("Dockerfile"), HasSubstr("CMD [\"eyrie\", \"health\"]"));
    for (const char* name :
         {"EYRIE_TOKEN_FILE", "EYRIE_TLS_CERT", "EYRIE_TLS_KEY", "EYRIE_TLS_CA", "EYRIE_TLS_NAME"})
        EXPECT_THAT(text, HasSubstr(name));
    EXPECT_THAT(text, Not(HasSubstr("--t"))) << "an option that no health check would know of";
    const std::string tls = "--tls-cert --tls-key --tls-ca --tls-name";
    expectKnown({"health"}, tls, "the health check");
    for (const char* command : {"coordinator", "renderer"})
        expectKnown({command}, "--token-file " + tls, command);
}

/// Compose builds for all services at once, and fails where two of them make the same image.
TEST(Deploy, ComposeBuildsTheImageOnce) {
    const std::string text = textOf("compose.yaml");
    const std::size_t build = text.find(" build: ");
    EXPECT_EQ(text.find(" build: ", build + 1), std::string::npos);
    EXPECT_GT(build, text.find("\n  coordinator:\n"));
    EXPECT_LT(build, text.find("\n  renderer-1: "));
    const std::size_t renderer = text.find("\nx-renderer:");
    EXPECT_THAT(text.substr(renderer, text.find("\nservices:") - renderer),
                HasSubstr("\n  pull_policy: never"));
}

/// It listens on all of the container's addresses, but is published to one machine.
TEST(Deploy, WhereNobodyIsAskedForATokenNoStrangersNameIsAnswered) {
    const std::string compose = textOf("compose.yaml");
    std::smatch command;
    ASSERT_TRUE(std::regex_search(compose, command, std::regex("command: \\[coordinator,[^\n]*")));
    EXPECT_THAT(command.str(), HasSubstr(" --insecure, --local-names-only,"));
    EXPECT_THAT(textOf("helm/eyrie/templates/coordinator.yaml"),
                HasSubstr("{{- if not (or .Values.access.tokenSecret .Values.access.tlsSecret) }}\n"
                          "            - --local-names-only\n"));
}

/// No registry has the image that the chart asks for by itself.
TEST(Deploy, ReadmeSaysWhichImageTheChartTakes) {
    const std::string readme = test::sourceText("README.md");
    std::smatch install;
    ASSERT_TRUE(std::regex_search(readme, install, std::regex("helm install [^`]*")));
    for (const char* name : {"image.repository=", "image.tag="})
        EXPECT_THAT(install.str(), HasSubstr(name));
}

TEST(Deploy, TheChartIsOfThisVersion) {
    const std::string chart = textOf("helm/eyrie/Chart.yaml");
    const std::string said = test::eyrie({"--version"}).output;
    std::smatch version;
    ASSERT_TRUE(std::regex_search(said, version, std::regex("[0-9]+\\.[0-9]+\\.[0-9]+"))) << said;
    EXPECT_THAT(chart, HasSubstr("\nversion: " + version.str() + "\n"));
    EXPECT_THAT(chart, HasSubstr("\nappVersion: \"" + version.str() + "\"\n"));
}

}  // namespace
}  // namespace eyrie
