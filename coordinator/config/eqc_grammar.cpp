// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/eqc_grammar.h"

#include <charconv>
#include <memory>

#include <fmt/format.h>
#include <tao/pegtl.hpp>

namespace eyrie::config {
namespace rules {

namespace peg = tao::pegtl;

struct VersionNumber : peg::seq<peg::plus<peg::digit>, peg::one<'.'>, peg::plus<peg::digit>> {};
struct VersionLine : peg::seq<TAO_PEGTL_STRING("#Equalizer"), peg::plus<peg::blank>, VersionNumber,
                              peg::plus<peg::blank>, TAO_PEGTL_STRING("ascii")> {};
struct RestOfLine : peg::until<peg::at<peg::eolf>, peg::bytes<1>> {};
struct Comment : peg::seq<peg::sor<VersionLine, peg::one<'#'>, peg::two<'/'>>, RestOfLine,
                          peg::opt<peg::eol>> {};

struct Open : peg::one<'{'> {};
struct Close : peg::one<'}'> {};
struct OpenList : peg::one<'['> {};
struct CloseList : peg::one<']'> {};
struct OpenReference : peg::one<'('> {};
struct CloseReference : peg::one<')'> {};

struct WordEnd : peg::not_at<peg::identifier_other> {};
struct Sign : peg::opt<peg::one<'+', '-'>> {};
struct Real  // 1.f as in C, which files of Equalizer's have
    : peg::seq<Sign,
               peg::sor<peg::seq<peg::plus<peg::digit>, peg::one<'.'>, peg::star<peg::digit>>,
                        peg::seq<peg::one<'.'>, peg::plus<peg::digit>>>,
               peg::opt<peg::one<'f'>>, WordEnd> {};
struct Integer : peg::seq<Sign, peg::plus<peg::digit>, WordEnd> {};
struct Word : peg::plus<peg::identifier_other> {};  // 2D begins with a digit
struct TextEnd : peg::one<'"'> {};
struct TextBody : peg::star<peg::not_one<'"', '\n', '\r', '\0'>> {};
struct Text : peg::seq<peg::one<'"'>, TextBody, TextEnd> {};
struct Character : peg::seq<peg::one<'\''>, peg::not_one<'\n', '\r', '\0'>, peg::one<'\''>> {};
struct UnendedText : peg::seq<peg::one<'"'>, TextBody> {};
struct MayBegin
    : peg::sor<peg::space, peg::identifier_other,
               peg::one<'#', '/', '{', '}', '[', ']', '(', ')', '"', '\'', '+', '-', '.'>> {};
struct Stray : peg::seq<peg::bytes<1>, peg::star<peg::not_at<MayBegin>, peg::bytes<1>>> {};

struct Token : peg::sor<peg::space, Comment, Open, Close, OpenList, CloseList, OpenReference,
                        CloseReference, Real, Integer, Word, Text, Character, UnendedText, Stray> {
};
struct File : peg::seq<peg::star<Token>, peg::eof> {};

}  // namespace rules

namespace {

using Form = Statement::Form;

/// Puts tokens together. What is open is kept in a list of its own, so that no text is too deep
/// for the stack.
class Builder {
public:
    explicit Builder(Findings& findings) : findings_(findings) {}

    void scalar(Scalar scalar) {
        if (isIgnored())
            return;
        Statement* const last = lastStatement();
        if (isInList_ || (last != nullptr && last->form == Form::Missing) ||
            (last != nullptr && last->form == Form::Plain && scalar.kind != Scalar::Kind::Word)) {
            if (!isInList_)
                last->form = Form::Plain;
            last->values.push_back(std::move(scalar));
        } else if (scalar.kind == Scalar::Kind::Word) {
            if (++count_ > kMostStatements)
                return tooMany(scalar.place);
            statements().push_back({std::move(scalar.text), scalar.place});
        } else {
            findings_.error(scalar.place, fmt::format("'{}' belongs to no keyword", scalar.text));
        }
    }

    void open(Form form, char sign, const Place& place) {
        endOpenList(sign, place);
        if (form == Form::List ? isIgnored() : isIgnored() || open_.size() == kMostNesting) {
            if (form != Form::List && ignored_++ == 0 && count_ <= kMostStatements)
                tooDeep(form, place);
            return;
        }
        Statement* last = lastStatement();
        if (last == nullptr || last->form != Form::Missing) {
            findings_.error(place, fmt::format("'{}' belongs to no keyword", sign));
            if (++count_ > kMostStatements)
                return tooMany(place);
            statements().push_back({"", place});
            last = lastStatement();
        }
        last->form = form;
        if (form == Form::List)
            isInList_ = true;
        else
            open_.push_back({std::exchange(*last, {}), place});
    }

    void close(Form form, char sign, const Place& place) {
        if (form == Form::List) {
            if (!isInList_ && !isIgnored())
                findings_.error(place, "']' closes nothing");
            isInList_ = false;
            return;
        }
        endOpenList(sign, place);
        if (ignored_ > 0) {
            --ignored_;
            return;
        }
        if (open_.empty()) {
            findings_.error(place, fmt::format("'{}' closes nothing", sign));
            return;
        }
        if (open_.back().statement.form != form)
            findings_.error(place, fmt::format("'{}' closes '{}', which began with '{}'", sign,
                                               open_.back().statement.keyword,
                                               form == Form::Block ? '(' : '{'));
        checkLast();
        Statement done = std::move(open_.back().statement);
        open_.pop_back();
        statements().back() = std::move(done);
    }

    EqcText finish() {
        isInList_ = false;
        while (!open_.empty()) {
            const Open& open = open_.back();
            findings_.error(open.place, fmt::format("what opens here, of '{}', is never closed",
                                                    open.statement.keyword));
            close(open.statement.form, '}', open.place);
        }
        checkLast();
        return std::move(text_);
    }

    void error(const Place& place, std::string message) {
        findings_.error(place, std::move(message));
    }

    /// Of the first line that says it: others are comments, such as what a file once was.
    void version(std::string number, Place place) {
        if (text_.version.empty()) {
            text_.version = std::move(number);
            text_.versionPlace = std::move(place);
        }
    }

private:
    struct Open {
        Statement statement;
        Place place;
    };

    /// Before what has no place in a list.
    void endOpenList(char sign, const Place& place) {
        if (std::exchange(isInList_, false))
            findings_.error(place, fmt::format("'{}' within [ ]: is a ']' missing?", sign));
    }
    bool isIgnored() const { return ignored_ > 0 || count_ > kMostStatements; }
    void tooMany(const Place& place) {
        findings_.error(place, fmt::format("more than {} statements", kMostStatements));
    }
    void tooDeep(Form form, const Place& place) {
        findings_.error(place, fmt::format("more than {} blocks within each other", kMostNesting));
        if (Statement* const last = lastStatement(); last != nullptr && last->form == Form::Missing)
            last->form = form;
    }
    std::vector<Statement>& statements() {
        return open_.empty() ? text_.statements : open_.back().statement.statements;
    }
    Statement* lastStatement() { return statements().empty() ? nullptr : &statements().back(); }
    void checkLast() {
        const Statement* const last = lastStatement();
        if (last != nullptr && last->form == Form::Missing)
            findings_.error(last->place, fmt::format("'{}' has no value", last->keyword));
    }

    Findings& findings_;
    EqcText text_;
    std::vector<Open> open_;   ///< blocks, outermost first; their statements still being gathered
    std::size_t ignored_ = 0;  ///< blocks deeper than kMostNesting
    std::size_t count_ = 0;    ///< statements
    bool isInList_ = false;
};

template <typename In>
Place placeOf(const In& in) {
    return {in.position().line, in.position().column};
}

template <typename In>
void addNumber(const In& in, Builder& builder, Scalar::Kind kind) {
    Scalar scalar{kind, in.string(), 0, placeOf(in)};
    const char* const begin = scalar.text.data() + (scalar.text.front() == '+' ? 1 : 0);
    const char* const end = scalar.text.data() + scalar.text.size();
    if (std::from_chars(begin, end, scalar.number).ec != std::errc())
        builder.error(scalar.place, fmt::format("{} is beyond all numbers", scalar.text));
    builder.scalar(std::move(scalar));
}

/// "1.2" of a line "#Equalizer 1.2 ascii".
std::string versionIn(std::string_view line) {
    const std::size_t begin = line.find_first_of("0123456789");
    return std::string(line.substr(begin, line.find_first_not_of("0123456789.", begin) - begin));
}

std::string strayMessage(char byte) {
    if (byte == '/')
        return "'/' means nothing here; comments begin with # or //";
    if (byte > ' ' && byte <= '~')
        return fmt::format("'{}' means nothing here", byte);
    return fmt::format("the byte {:#04x} means nothing here", static_cast<unsigned char>(byte));
}

template <typename Rule>
struct Action : tao::pegtl::nothing<Rule> {};

#define EYRIE_ACTION(RULE, STATEMENT)                       \
    template <>                                             \
    struct Action<rules::RULE> {                            \
        template <typename In>                              \
        static void apply(const In& in, Builder& builder) { \
            STATEMENT;                                      \
        }                                                   \
    };
EYRIE_ACTION(VersionLine, builder.version(versionIn(in.string_view()), placeOf(in)))
EYRIE_ACTION(Open, builder.open(Form::Block, '{', placeOf(in)))
EYRIE_ACTION(Close, builder.close(Form::Block, '}', placeOf(in)))
EYRIE_ACTION(OpenList, builder.open(Form::List, '[', placeOf(in)))
EYRIE_ACTION(CloseList, builder.close(Form::List, ']', placeOf(in)))
EYRIE_ACTION(OpenReference, builder.open(Form::Reference, '(', placeOf(in)))
EYRIE_ACTION(CloseReference, builder.close(Form::Reference, ')', placeOf(in)))
EYRIE_ACTION(Real, addNumber(in, builder, Scalar::Kind::Real))
EYRIE_ACTION(Integer, addNumber(in, builder, Scalar::Kind::Integer))
EYRIE_ACTION(Word, builder.scalar({Scalar::Kind::Word, in.string(), 0, placeOf(in)}))
EYRIE_ACTION(Text, builder.scalar({Scalar::Kind::Text, std::string(in.begin() + 1, in.end() - 1), 0,
                                   placeOf(in)}))
EYRIE_ACTION(Character, builder.scalar({Scalar::Kind::Character,
                                        std::string(in.begin() + 1, in.end() - 1), 0, placeOf(in)}))
EYRIE_ACTION(UnendedText, builder.error(placeOf(in), "no '\"' ends the text that begins here"))
EYRIE_ACTION(Stray, builder.error(placeOf(in), strayMessage(*in.begin())))
#undef EYRIE_ACTION

}  // namespace

EqcText parseEqc(std::string_view text, Findings& findings) {
    if (text.size() > kLongestText) {
        findings.error(
            {}, fmt::format("{} bytes; a configuration has at most {}", text.size(), kLongestText));
        return {};
    }
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark))  // as editors of Windows write
        text.remove_prefix(kByteOrderMark.size());
    tao::pegtl::memory_input input(text.data(), text.data() + text.size(), "");
    Builder builder(findings);
    tao::pegtl::parse<rules::File, Action>(input, builder);
    return builder.finish();
}

}  // namespace eyrie::config
