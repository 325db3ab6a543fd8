// The table of options: every row can be read, refused and written, whoever adds one.
#include "experiments/method/options.h"

#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

// A value that the option takes: a word that a shell or its type offers, or 1; of a flag "".
std::string value_of(const Option& option) {
  if (*option.type == 0) return "";
  std::vector<std::string> values = option.words;
  for (const std::string& word : split_list(option.type, '|')) values.push_back(word);
  values.push_back("1");
  for (const std::string& value : values) {
    try {
      RunOptions options;
      options.method = Method::far;
      if (option.take(value, options)) return value;
    } catch (const Error&) {
    }
  }
  ADD_FAILURE() << option.name << " takes none of its own words";
  return "";
}

TEST(Options, MethodsRefuseWhatTheyDoNotHave) {
  for (const Option& option : run_options()) {
    if (!option.take) continue;
    for (const Method method : all_methods()) {
      const GivenOptions given = {{"method", to_string(method)}, {option.name, value_of(option)}};
      if (option.serves(traits(method))) continue;
      const Error error = error_of([&] { read_options(given); });
      EXPECT_EQ(error.where, option_word(option.name)) << to_string(method);
      EXPECT_TRUE(has_text(error.remedy, "leave " + error.where + " out"));
    }
  }
}

TEST(Options, RefuseValuesThatAreNone) {
  for (const Option& option : run_options()) {
    if (!option.take || *option.type == 0) continue;
    RunOptions options;
    options.method = Method::far;
    for (const std::string bad : {"", "?", "-1"}) {
      if (std::string(option.name) == "offset" || std::string(option.name) == "views") continue;
      const Error error = error_of([&] { take_option(option.name, bad, options); });
      EXPECT_EQ(error.where, option_word(option.name)) << bad;
      EXPECT_NE(error.remedy, "");
    }
  }
  EXPECT_EQ(error_of([] { read_options({{"method", "far"}, {"offset", "?"}}); }).where, "--offset");
  EXPECT_EQ(error_of([] { read_options({{"views", "?"}}); }).where, "--views");
}

// Typed values are checked where no text was read, too.
TEST(Options, TypedValuesHaveTheSameRanges) {
  const auto where = [](const RunOptions& options) {
    return error_of([&] { validate(options); }).where;
  };
  EXPECT_EQ(where({.resolution = -1}), "--resolution");
  EXPECT_EQ(where({.method = Method::cullide, .rounds = -1}), "--rounds");
  EXPECT_EQ(where({.clearance = -1}), "--clearance");
  EXPECT_EQ(where({.offset = "round"}), "--offset");
  EXPECT_EQ(where({.device = "nope"}), "--device");
  EXPECT_EQ(where({.method = Method::exact, .conservative = true}), "--conservative");
}

TEST(Options, RecordsHoldThem) {
  RunOptions options;
  options.device = "native";
  options.verify = false;
  Session session(options.device);
  const Scene scene = make_builtin_scene("far-apart");
  const nlohmann::ordered_json json = to_json(scene, run(scene, options, session));
  for (const Option& option : run_options()) {
    if (option.value) {
      EXPECT_TRUE(json.contains(option.name)) << option.name;
    }
    EXPECT_NE(option.help, "") << option.name;
  }
}

TEST(Options, AFormIsReadBackFromItsWords) {
  RunOptions form{.method = Method::cullide, .rounds = 3, .clear = ClearRule::all};
  form.objects_alone = form.conservative = true;
  EXPECT_EQ(form_text(form), "--rounds 3 --clear all --level objects --conservative");
  form.method = Method::boxes;
  EXPECT_EQ(form_text(with_fitting_form(form)), "");
  form.method = Method::s_cullide;
  EXPECT_EQ(form_text(with_fitting_form(form)), "--rounds 3 --clear all --conservative");
}

TEST(Error, SpellsParametersAsTheProgramDoes) {
  EXPECT_EQ(spelled("use {depth_format} 24 or {x.off}, {}"),
            "use --depth-format 24 or {x.off}, {}");
  EXPECT_EQ(spelled("{open"), "{open");
  EXPECT_EQ(spelled("see `{doctor}`"), "see `farcull doctor`");
  EXPECT_EQ(Error("{device}", "a", "b").where, "--device");
}

// Every name in braces that a text of the product holds is one that the program spells; the name of
// a file is not.
TEST(Error, LeavesOtherNamesInBraces) {
  for (const Option& option : run_options()) EXPECT_FALSE(option_word(option.name).empty());
  EXPECT_EQ(option_word("no_verify"), "--no-verify");
  EXPECT_EQ(option_word("left"), "");
}

}  // namespace
}  // namespace farcull
