// A small command line as data, as manual pages, as a completion. How man and bash take those of the program:
// tests/install/pages_test.py.

#include "emulator/subcommands/command_pages.h"

#include <gmock/gmock.h>

#include <array>

#include "emulator/send/command_examples.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Line {
    std::string file, what, stage;
    std::array<double, 3> place{};
    int port = 0;
    double seconds = 2;
    bool fast = false;
    CLI::App app{"a camera"};

    Line() {
        CLI::App* run = app.add_subcommand("run", "be it; .dots and back\\slashes, too");
        run->add_option("config", file, "a file")->required();
        run->add_option("--port", port, "where it listens")->check(CLI::Range(1, 65535));
        run->add_option("-s,--seconds", seconds, "how long")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
        run->add_flag("--fast", fast, "at once");
        CLI::App* send = app.add_subcommand("send", "say something");
        CLI::App* lamp = send->add_subcommand("lamp", "switch it");
        lamp->add_option("what", what, "the way")->check(CLI::IsMember({"on", "off"}));
        lamp->add_option("--place-m", place, "x y z")->required();
        app.add_subcommand("hidden", "of no page")->group("");
        set_examples(run, {"hilcam run a.yaml --fast"});
        set_examples(lamp, {"hilcam send lamp on"});
    }
};

TEST(OptionTree, HasWhatPeopleReadOfTheCommandLine) {
    Line line;
    const CommandText all = described(line.app);
    ASSERT_EQ(all.commands.size(), 2u);
    const CommandText& run = all.commands[0];
    ASSERT_EQ(run.options.size(), 5u);  // --help first
    EXPECT_TRUE(run.options[1].is_positional && run.options[1].is_required && run.options[1].takes_files);
    EXPECT_EQ(run.options[2].accepted, "1 to 65535");
    EXPECT_EQ(run.options[2].value, "N");
    EXPECT_EQ(run.options[3].names, (std::vector<std::string>{"-s", "--seconds"}));
    EXPECT_EQ(run.options[3].accepted, "above 0");
    EXPECT_EQ(run.options[3].usual, "2");
    EXPECT_EQ(run.options[4].value, "");
    const CommandText& lamp = all.commands[1].commands[0];
    EXPECT_EQ(lamp.options[1].words, (std::vector<std::string>{"on", "off"}));
    EXPECT_EQ(lamp.options[2].value, "NUMBER NUMBER NUMBER");
}

TEST(ManualPages, EachSubcommandHasOneWithThoseBelowIt) {
    Line line;
    const std::vector<NamedText> pages = manual_pages(described(line.app), "hilcam 9.9.9");
    ASSERT_EQ(pages.size(), 3u);
    EXPECT_EQ(pages[0].name, "hilcam.1");
    EXPECT_THAT(pages[0].text, HasSubstr(".BR hilcam\\-run (1)"));
    EXPECT_EQ(pages[1].name, "hilcam-run.1");
    EXPECT_THAT(pages[1].text, HasSubstr("\\fBhilcam run\\fR [\\fIOPTION\\fR]... \\fICONFIG\\fR\n"));
    EXPECT_THAT(
        pages[1].text,
        HasSubstr("\\fB\\-s\\fR, \\fB\\-\\-seconds\\fR \\fINUMBER\\fR\nhow long; accepted: above 0 [2]\n"));
    EXPECT_THAT(pages[1].text, HasSubstr("back\\eslashes"));
    EXPECT_THAT(pages[2].text, HasSubstr(".SS lamp\n"));
    EXPECT_THAT(pages[2].text, HasSubstr("\\fIWHAT\\fR\nthe way; accepted: on|off\n"));
    EXPECT_THAT(pages[1].text, HasSubstr(".SH EXAMPLES\n.nf\nhilcam run a.yaml \\-\\-fast\n.fi\n"));
    EXPECT_THAT(pages[2].text, HasSubstr(".SH EXAMPLES\n.nf\nhilcam send lamp on\n.fi\n"));
    EXPECT_THAT(pages[0].text, Not(HasSubstr("EXAMPLES")));
    for (const NamedText& page : pages) EXPECT_THAT(page.text, Not(HasSubstr("hidden")));
}

TEST(BashCompletion, KnowsCommandsOptionsWordsAndFiles) {
    Line line;
    const std::string script = bash_completion(described(line.app), {"camera.bits", "objects.N.mesh"});
    EXPECT_THAT(script, HasSubstr("    ['.']='run send'\n"));
    EXPECT_THAT(script, HasSubstr("    ['run']='-h --help --port -s --seconds --fast'\n"));
    EXPECT_THAT(script, HasSubstr("    ['run']='@config'\n"));
    EXPECT_THAT(script, HasSubstr("    ['send lamp']='on off'\n"));
    EXPECT_THAT(script, HasSubstr("    ['run --port']=''\n"));
    EXPECT_THAT(script, HasSubstr("_hilcam_keys='camera.bits objects.N.mesh'\n"));
    EXPECT_THAT(script, Not(HasSubstr("run --fast")));
    EXPECT_THAT(script, Not(HasSubstr("hidden")));
}

}  // namespace
}  // namespace hilcam
