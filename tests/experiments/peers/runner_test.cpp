// The runner and the score on contestants that lie: each fault is reported exactly as it is.
#include "experiments/peers/runner.h"

#include "experiments/peers/score.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr std::size_t kPairs = 200;

/// Pairs of random triangles about half of which meet. The first coordinate of each begins with
/// its number, by which liars choose.
std::vector<SuitePair> random_pairs() {
  std::vector<SuitePair> out;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> within(-1, 1);
  for (std::size_t i = 0; i < kPairs; ++i) {
    SuitePair& pair = out.emplace_back();
    pair.id = i;
    do {
      for (std::array<Vec3, 3>* triangle : {&pair.a, &pair.b}) {
        for (Vec3& p : *triangle) {
          p = Vec3(within(random), within(random), within(random));
          p.x() += static_cast<double>(i) + 0.5;
        }
      }
      pair.a[0].x() = static_cast<double>(i) + 0.25;
      // Those that a liar drops have to meet, or nobody would see it.
    } while (i % 100 == 99 && !intersects(pair.a, pair.b));
    pair.kind = intersects(pair.a, pair.b) ? SuiteKind::crossing : SuiteKind::apart;
  }
  return out;
}

const std::vector<SuitePair>& pairs() {
  static const std::vector<SuitePair> all = random_pairs();
  return all;
}

Invited liar(const std::string& name) { return invite({FARCULL_LIAR, name}); }

/// The contestants of the program of textbook tests.
std::vector<Invited> textbook() {
  std::vector<Invited> out;
  for (const KnownContestant& known : known_contestants()) {
    if (known.program == "textbook") out.push_back(invite({FARCULL_TEXTBOOK, known.name}));
  }
  return out;
}

// No answer takes this long: what takes longer, as beside other tests, is not taken for a hang.
const ContestLimits kShort{.answer_s = 10, .start_s = 20, .cpu_s = 20, .memory_mib = 256};
// Where a hang is expected.
const ContestLimits kHasty{.answer_s = 0.5, .start_s = 20, .cpu_s = 20, .memory_mib = 256};

/// The scores of all pairs, which have no parameter, as one.
Score sum_of(const Invited& invited, const PairsAnswer& answer) {
  Score out;
  for (const Score& score : score_pairs(invited.card, pairs(), answer)) add(score, out);
  return out;
}

/// Where the answers had this outcome.
std::vector<std::size_t> with(const PairsAnswer& answer, ContestOutcome outcome) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < answer.answers.size(); ++i)
    if (answer.answers[i].outcome == outcome) out.push_back(i);
  return out;
}

using Positions = std::vector<std::size_t>;

TEST(ContestRunner, PairsMeetAndAreApart) {
  const auto meet = std::ranges::count_if(
      pairs(), [](const SuitePair& pair) { return pair.kind == SuiteKind::crossing; });
  EXPECT_GT(meet, 20);
  EXPECT_LT(meet, 180);
}

TEST(ContestRunner, TheHonestHasNoFault) {
  const Invited invited = liar("honest");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 10);
  Score expected{.asked = kPairs, .answered = kPairs, .own_asked = kPairs, .twice = kPairs / 10};
  Score sum = sum_of(invited, answer);
  EXPECT_GT(sum.ns, 0);
  sum.ns = 0;
  EXPECT_EQ(sum, expected) << scores_text({sum});
  EXPECT_EQ(answer.processes, 2u);
}

TEST(ContestRunner, ADroppedPairIsMissed) {
  const Invited invited = liar("drops");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 0);
  const std::uint64_t dropped =
      (pairs()[99].kind == SuiteKind::crossing) + (pairs()[199].kind == SuiteKind::crossing);
  ASSERT_GT(dropped, 0u);
  EXPECT_EQ(sum_of(invited, answer).missed, dropped);
  EXPECT_EQ(sum_of(invited, answer).own_missed, dropped);
  EXPECT_EQ(sum_of(invited, answer).wrong, 0u);
}

TEST(ContestRunner, ACrashIsNamedAtItsPairAndTheRestIsAsked) {
  const Invited invited = liar("crashes");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 0);
  EXPECT_EQ(with(answer, ContestOutcome::crashed), (Positions{99, 199}));
  EXPECT_EQ(answer.answers[99].reason, "SIGSEGV");
  EXPECT_EQ(sum_of(invited, answer).missed, 0u);
  EXPECT_EQ(sum_of(invited, answer).wrong, 0u);
  EXPECT_EQ(answer.processes, 2u);
}

TEST(ContestRunner, AnAssertionIsACrashWithItsWords) {
  const PairsAnswer answer = ask_pairs(liar("asserts"), pairs(), kShort, 0);
  EXPECT_EQ(with(answer, ContestOutcome::crashed), Positions{7});
  EXPECT_EQ(answer.answers[7].reason, "SIGABRT: liar.cpp: Assertion `honest' failed.");
}

TEST(ContestRunner, AHangEndsAtTheLimit) {
  const PairsAnswer answer = ask_pairs(liar("hangs"), pairs(), kHasty, 0);
  EXPECT_EQ(with(answer, ContestOutcome::hung), Positions{150});
  EXPECT_EQ(with(answer, ContestOutcome::crashed), Positions{});
}

TEST(ContestRunner, MemoryWithoutEndIsNoMemory) {
  const PairsAnswer answer = ask_pairs(liar("takes-all-memory"), pairs(), kShort, 0);
  EXPECT_EQ(with(answer, ContestOutcome::no_memory), Positions{33});
  EXPECT_EQ(with(answer, ContestOutcome::crashed), Positions{});
}

// The limit is one of the process, so no pair is to blame.
TEST(ContestRunner, ALeakIsNoFaultOfThePairAtWhichItEnds) {
  const Invited invited = liar("leaks");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 0);
  EXPECT_EQ(with(answer, ContestOutcome::no_memory), Positions{});
  EXPECT_EQ(sum_of(invited, answer).answered, kPairs);
  EXPECT_GT(answer.processes, 2u) << "it never ran out of memory, so this shows nothing";
}

TEST(ContestRunner, AnotherAnswerTheSecondTimeIsReported) {
  const Invited invited = liar("differs");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 10);
  EXPECT_EQ(answer.asked_twice, kPairs / 10);
  EXPECT_EQ(answer.differing, Positions{190});  // the first that is asked again
  EXPECT_EQ(sum_of(invited, answer).differing, 1u);
  EXPECT_EQ(sum_of(invited, answer).missed + sum_of(invited, answer).wrong, 0u);
}

TEST(ContestRunner, AProgramThatLeavesHasNoAnswerToItsPair) {
  const PairsAnswer answer = ask_pairs(liar("leaves"), pairs(), kShort, 0);
  // The questions that were left in its pipe are asked in a new process.
  EXPECT_EQ(with(answer, ContestOutcome::unanswered), Positions{120});
  EXPECT_EQ(with(answer, ContestOutcome::crashed), Positions{});
  EXPECT_EQ(answer.processes, 2u);
}

TEST(ContestRunner, ARefusalIsHonest) {
  const Invited invited = liar("refuses");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 0);
  EXPECT_EQ(with(answer, ContestOutcome::refused).size(), kPairs / 10);
  EXPECT_EQ(answer.answers[13].reason, "not this one");
  EXPECT_EQ(sum_of(invited, answer).missed, 0u);
}

TEST(ContestRunner, WhatALibraryPrintsIsNoAnswer) {
  const Invited invited = liar("talks");
  const PairsAnswer answer = ask_pairs(invited, pairs(), kShort, 0);
  Score sum = sum_of(invited, answer);
  sum.ns = 0;
  EXPECT_EQ(sum, (Score{.asked = kPairs, .answered = kPairs, .own_asked = kPairs}))
      << scores_text({sum});
}

/// A shell script in the place of a program.
Invited script(const std::string& text) {
  return {.card = {.name = "script", .library = "sh"}, .program = {"/bin/sh", "-c", text}};
}

TEST(ContestRunner, AProgramOfAnotherKindIsReportedToo) {
  const auto span = std::span(pairs()).first(3);
  ContestLimits hasty = kShort;
  hasty.start_s = 0.5;
  const auto outcomes = [&](const std::string& text) {
    std::vector<std::string> out;
    for (const ContestAnswer& answer : ask_pairs(script(text), span, hasty, 0).answers)
      out.push_back(to_string(answer.outcome));
    return out;
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(outcomes("exit 0"), (Words{"unanswered", "unanswered", "unanswered"}));
  EXPECT_EQ(outcomes("exit 4"), (Words{"crashed", "crashed", "crashed"}));
  EXPECT_EQ(outcomes("cat > /dev/null; printf '0\\t1\\t5\\n2\\t0\\t5\\n'"),
            (Words{"meets", "unanswered", "apart"}));
  EXPECT_EQ(outcomes("printf 'hello\\n'; cat > /dev/null"),
            (Words{"crashed", "crashed", "crashed"}));
  EXPECT_EQ(outcomes("cat > /dev/null; printf '0\\t2\\t5\\n'"),
            (Words{"crashed", "crashed", "crashed"}));
  EXPECT_EQ(outcomes("while :; do :; done"), (Words{"hung", "hung", "hung"}));
}

TEST(ContestRunner, AskingEndsAfterManyDeaths) {
  ContestLimits limits = kShort;
  limits.most_deaths = 5;
  const PairsAnswer answer = ask_pairs(script("exit 4"), pairs(), limits, 0);
  EXPECT_EQ(with(answer, ContestOutcome::crashed).size(), 5u);
  EXPECT_EQ(with(answer, ContestOutcome::not_asked).size(), kPairs - 5);
}

TEST(ContestRunner, ProgramsWithoutCardsAreRefused) {
  EXPECT_TRUE(refuses("cannot be started", [] { (void)invite({"/no/such/program"}); }));
  const auto says = [](const std::string& text) {
    return invite({"/bin/sh", "-c", "printf '" + text + "'"});
  };
  EXPECT_TRUE(refuses("lacks", [&] { (void)says("0\\tcard\\tname\\tx\\n0\\tdone\\n"); }));
  EXPECT_TRUE(refuses("colour", [&] { (void)says("0\\tcard\\tcolour\\tred\\n0\\tdone\\n"); }));
  EXPECT_TRUE(refuses("gives no card", [&] { (void)says("0\\trefused\\tno\\n"); }));
  EXPECT_TRUE(refuses("gives no card", [&] { (void)says("0\\tcard\\tname\\tx\\n"); }));
}

/// Fans of triangles that cross each other many times.
struct MeshCase {
  ScratchFolder folder;
  SuiteMesh mesh;

  MeshCase() {
    mesh.name = "case";
    std::vector<SuitePair> some = random_pairs();
    for (int o = 0; o < 2; ++o) {
      Object object{.name = std::to_string(o),
                    .first_triangle = static_cast<std::uint32_t>(mesh.scene.triangles.size()),
                    .triangle_count = 60};
      std::string obj;
      for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
        std::array<Vec3, 3>& corners = o == 0 ? some[t].a : some[t].b;
        for (Vec3& p : corners) p.x() -= static_cast<double>(t);
        add_triangle(mesh.scene, corners);
      }
      for (const Vec3& p : std::span(mesh.scene.vertices).last(180)) {
        char line[100];
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
        obj += line;
      }
      for (int v = 1; v <= 180; v += 3)
        obj += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " +
               std::to_string(v + 2) + "\n";
      folder.write(std::to_string(o) + ".obj", obj);
      mesh.scene.objects.push_back(object);
    }
    for (const TrianglePair& pair : all_colliding_pairs(mesh.scene).pairs)
      mesh.pairs.push_back({pair, 0});
  }
};

TEST(ContestRunner, PairsOfAMeshThatAreDroppedAreMissed) {
  const MeshCase of;
  ASSERT_GT(of.mesh.pairs.size(), 300u);
  const Invited honest = liar("honest"), drops = liar("drops");
  const Score good =
      score_mesh(honest.card, of.mesh, ask_mesh(honest, of.mesh, of.folder.folder(), kShort));
  EXPECT_EQ(good.missed + good.wrong + good.differing, 0u);
  EXPECT_EQ(good.asked, of.mesh.pairs.size());
  const Score bad =
      score_mesh(drops.card, of.mesh, ask_mesh(drops, of.mesh, of.folder.folder(), kShort));
  EXPECT_EQ(bad.missed, of.mesh.pairs.size() / 100);
  EXPECT_EQ(bad.own_missed, bad.missed);
  EXPECT_EQ(bad.wrong, 0u);
}

TEST(ContestRunner, AMeshIsAskedByScriptsToo) {
  const MeshCase of;
  const auto outcome = [&](const std::string& text) {
    return to_string(
        ask_mesh(script(text), of.mesh, of.folder.folder(), {.answer_s = 0.5, .start_s = 0.5})
            .outcome);
  };
  EXPECT_EQ(outcome("printf '0\\tpair\\t0\\t1\\t1\\t5\\n0\\tdone\\t5\\n'"), "meets");
  EXPECT_EQ(outcome("printf '0\\tpair\\t0\\t1\\t1\\t60\\n0\\tdone\\t5\\n'"), "crashed");
  EXPECT_EQ(outcome("printf '0\\tpair\\t0\\t1\\t1\\t5\\n'"), "unanswered");
  EXPECT_EQ(outcome("kill -SEGV $$"), "crashed");
  EXPECT_EQ(outcome("sleep 100"), "hung");
}

// All that are built, on triangles in an order that says nothing: an adapter that names others
// misses nearly all pairs, a library that rounds at most a few. What a library reports wrongly is
// its own: Bullet reports 217 pairs that only come close.
TEST(ContestAdapters, NameTheTrianglesOfMeshes) {
  ::setenv("FARCULL_CONTESTANTS", FARCULL_CONTESTANTS_FOLDER, 1);
  const MeshCase of;
  std::size_t asked = 0;
  for (const KnownContestant& known : known_contestants()) {
    if (!known.meshes) continue;
    const Invitation invitation = invite_known(known);
    if (!invitation.invited) {
      std::printf("not asked: %s\n", invitation.missing.c_str());
      continue;
    }
    const Invited& invited = *invitation.invited;
    if (known.ours && !invited.card.promises) continue;  // CULLIDE's family misses
    const Score score = score_mesh(
        invited.card, of.mesh,
        ask_mesh(invited, of.mesh, of.folder.folder(), {.answer_s = 60, .start_s = 120}, false));
    SCOPED_TRACE(known.name + ": " + scores_text({score}));
    EXPECT_EQ(score.answered, of.mesh.pairs.size());
    EXPECT_LT(score.missed, of.mesh.pairs.size() / 10);
    if (known.ours) {
      EXPECT_EQ(score.missed + score.wrong, 0u);
    }
    ++asked;
  }
  EXPECT_GE(asked, 4u);
}

// A quotation stands between quotation marks, and with the place that it is from.
TEST(ContestAdapters, NameWhereTheirDocumentationSaysIt) {
  ::setenv("FARCULL_CONTESTANTS", FARCULL_CONTESTANTS_FOLDER, 1);
  for (const KnownContestant& known : known_contestants()) {
    const Invitation invitation = invite_known(known);
    if (!invitation.invited) continue;
    const ContestantCard& card = invitation.invited->card;
    SCOPED_TRACE(known.name);
    EXPECT_NE(card.says, "");
    EXPECT_NE(card.source, "");
    EXPECT_NE(card.use, "");
    for (const std::string& text : {card.says, card.use})
      EXPECT_EQ(std::ranges::count(text, '"') % 2, 0);
  }
}

// Written from the papers: on pairs that are far from touching, rounding decides nothing.
TEST(ContestTextbook, AgreesWithExactPredicatesFarFromContact) {
  const std::vector<Invited> all = textbook();
  EXPECT_GE(all.size(), 6u);
  for (const Invited& invited : all) {
    const Score sum = sum_of(invited, ask_pairs(invited, pairs(), kShort, 0));
    EXPECT_EQ(sum.missed + sum.wrong + sum.refused + sum.crashed, 0u) << invited.card.name;
    EXPECT_EQ(sum.asked, kPairs);
  }
}

// Two triangles whose planes are nearly one: in float they are one.
TEST(ContestTextbook, RoundingIsSeenNearContact) {
  SuitePair pair;
  pair.a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  pair.b = {Vec3(0, 0, 1e-9), Vec3(1, 0, 1e-9), Vec3(0, 1, 1e-9)};
  pair.kind = SuiteKind::apart;
  for (const Invited& invited : textbook()) {
    if (invited.card.name != "moeller-float" && invited.card.name != "guigue-devillers-double")
      continue;
    const PairsAnswer answer = ask_pairs(invited, std::span(&pair, 1), kShort, 0);
    EXPECT_EQ(to_string(answer.answers[0].outcome),
              invited.card.name == "moeller-float" ? "meets" : "apart");
  }
}

TEST(ContestMinimize, KeepsTheFaultWithFewDigits) {
  const auto crossing = std::ranges::find_if(
      pairs(), [](const SuitePair& pair) { return pair.kind == SuiteKind::crossing; });
  const PairFault fault{.pair = *crossing, .outcome = ContestOutcome::apart};
  const std::optional<SuitePair> small = minimized(liar("blind"), fault, kShort);
  ASSERT_TRUE(small);
  EXPECT_LT(cost_of(*small), 60u) << coordinates_text(*small);
  EXPECT_TRUE(intersects(small->a, small->b));
  // The honest has no such fault, as a library whose fault depends on what was asked before.
  EXPECT_FALSE(minimized(liar("honest"), fault, kShort));
}

TEST(ContestScore, MeasuresByTheContestantsOwnWords) {
  ContestantCard card{.name = "x", .library = "x", .means = Means::crossing, .degenerate = false};
  SuitePair pair = pairs()[0];
  const auto promised_of = [&](SuiteKind kind) {
    pair.kind = kind;
    return promised(card, pair);
  };
  EXPECT_EQ(promised_of(SuiteKind::crossing), true);
  EXPECT_EQ(promised_of(SuiteKind::apart), false);
  EXPECT_EQ(promised_of(SuiteKind::touch_vertex), std::nullopt);
  EXPECT_EQ(promised_of(SuiteKind::coplanar), std::nullopt);
  EXPECT_EQ(promised_of(SuiteKind::unlabelled), std::nullopt);
  card.means = Means::closed;
  EXPECT_EQ(promised_of(SuiteKind::touch_vertex), true);
  pair.b[1] = pair.b[0];
  EXPECT_EQ(promised_of(SuiteKind::touch_vertex), std::nullopt);
  card.degenerate = true;
  EXPECT_EQ(promised_of(SuiteKind::touch_vertex), true);
}

// Two triangles in planes that are 2^-4 apart.
TEST(ContestScore, PromisesNothingWithinTheMargin) {
  ContestantCard card{.name = "x", .library = "x", .means = Means::crossing, .degenerate = false};
  SuitePair pair = pairs()[0];
  pair.kind = SuiteKind::apart;
  pair.a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  pair.b = {Vec3(0, 0, 0.0625), Vec3(1, 0, 0.0625), Vec3(0, 1, 0.0625)};
  EXPECT_EQ(promised(card, pair), false);
  card.margin = 0.0625;
  EXPECT_EQ(promised(card, pair), std::nullopt);
  card.margin = std::nextafter(0.0625, 0);
  EXPECT_EQ(promised(card, pair), false);
  card.margin = 1;
  pair.kind = SuiteKind::crossing;
  EXPECT_EQ(promised(card, pair), true);
}

TEST(ContestScore, IsReadBackFromItsText) {
  const std::vector<Score> scores = {
      {.parameter = 1e-300, .kind = "apart", .asked = 12, .wrong = 3, .ns = 1.5, .reason = "a b"},
      {.parameter = -2, .kind = "mesh", .missed = 1, .differing = 7}};
  EXPECT_EQ(parse_scores(scores_text(scores)), scores);
  EXPECT_EQ(parse_scores(""), std::vector<Score>{});
  EXPECT_NE(message_of([] { (void)parse_scores("1 apart 2|x"); }), "");
}

TEST(ContestScore, CountsWhatWasAnsweredAndWhatWasNotAskedApart) {
  const ContestantCard card{.name = "x", .library = "x", .means = Means::closed};
  std::vector<SuitePair> asked(4, pairs()[0]);
  for (SuitePair& pair : asked) pair.kind = SuiteKind::crossing;
  PairsAnswer answer;
  answer.answers = {{.outcome = ContestOutcome::apart},
                    {.outcome = ContestOutcome::meets},
                    {.outcome = ContestOutcome::crashed},
                    {.outcome = ContestOutcome::not_asked}};
  const std::vector<Score> scores = score_pairs(card, asked, answer);
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_EQ(scores[0].asked, 3u);
  EXPECT_EQ(scores[0].answered, 2u);
  EXPECT_EQ(scores[0].own_asked, 2u);
  EXPECT_EQ(scores[0].missed, 1u);
  EXPECT_EQ(scores[0].crashed, 1u);
  EXPECT_EQ(scores[0].not_asked, 1u);
}

TEST(ContestRunner, AProgramThatIsGoneIsNoFaultOfTheLibrary) {
  Invited gone = liar("honest");
  gone.program = {"/no/such/program"};
  EXPECT_TRUE(refuses("cannot be started", [&] { (void)ask_pairs(gone, pairs(), kShort, 0); }));
}

TEST(ContestCard, IsReadBackFromItsText) {
  ContestantCard card{.name = "x",
                      .library = "x 1",
                      .means = Means::crossing,
                      .degenerate = false,
                      .neighbours = true,
                      .margin = 0.1,
                      .answers = "pair mesh",
                      .call = "f()",
                      .says = "nothing\nat all",
                      .source = "README,\nsection 1",
                      .use = "here"};
  const ContestantCard read = read_card(card_text(card), "test");
  card.says = "nothing at all";
  card.source = "README, section 1";
  EXPECT_EQ(card_text(read), card_text(card));
  EXPECT_EQ(read.means, Means::crossing);
  EXPECT_EQ(read.source, "README, section 1");
  EXPECT_EQ(read.margin, 0.1);
}

TEST(ContestCard, MayLeaveOutItsSourceButNotName) {
  const ContestantCard card{.name = "x",
                            .library = "x 1",
                            .answers = "pair",
                            .call = "f()",
                            .says = "nothing",
                            .use = "here"};
  const std::string text = card_text(card);
  EXPECT_FALSE(has_text(text, "source"));
  const ContestantCard read = read_card(text, "test");
  EXPECT_EQ(read.source, "");
  const std::string good = "name\tx\nlibrary\tx\nanswers\tpair\n";
  EXPECT_EQ(message_of([&] { (void)read_card(good, "t"); }), "");
  for (const char* bad : {"source\t\n", "sauce\ta\n", "margin\t-1\n", "means\tx\n"})
    EXPECT_NE(message_of([&] { (void)read_card(good + bad, "t"); }), "") << bad;
}

}  // namespace
}  // namespace farcull
