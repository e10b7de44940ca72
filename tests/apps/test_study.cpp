// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The study program: order of trials, the file of answers, statistics.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/study/analysis.h"
#include "apps/study/answers.h"
#include "apps/study/briefing.h"
#include "apps/study/schedule.h"
#include "apps/study/terminal.h"
#include "tests/support/temporary_folder.h"

namespace study {
namespace {

using spidar::test::TemporaryFolder;

const std::vector<std::string> kClips{"a.avi", "b.avi", "c.avi"};

TEST(StudySchedule, EveryParticipantSeesEveryClipInEveryCondition) {
  for (int index = 0; index < 20; ++index) {
    SCOPED_TRACE(index);
    const std::vector<Trial> trials = schedule(kClips, index, 7);
    ASSERT_EQ(trials.size(), 12u);
    std::set<std::string> seen, codes;
    for (size_t i = 0; i < trials.size(); ++i) {
      const Trial& trial = trials[i];
      EXPECT_EQ(trial.number, static_cast<int>(i) + 1);
      EXPECT_EQ(trial.part, i < 6 ? Part::kControllers : Part::kHaptics);
      EXPECT_EQ(trial.clip, trials[i / 2 * 2].clip) << "both conditions of a clip in a row";
      seen.insert(trial.clip + to_string(trial.condition));
      codes.insert(trial.code);
      EXPECT_EQ(trial.code.size(), 2u);
    }
    EXPECT_EQ(seen.size(), 12u);
    EXPECT_EQ(codes.size(), 12u) << "no code twice";
  }
}

TEST(StudySchedule, IsBalancedOverTwoParticipants) {
  for (int index = 0; index < 10; index += 2) {
    std::map<std::string, int> first;
    for (const int participant : {index, index + 1}) {
      const std::vector<Trial> trials = schedule(kClips, participant, 3);
      for (size_t i = 0; i < trials.size(); i += 2) {
        ++first[trials[i].clip + to_string(trials[i].condition)];
      }
    }
    EXPECT_EQ(first.size(), 12u);
    for (const auto& [what, count] : first) EXPECT_EQ(count, 1) << what;
  }
}

TEST(StudySchedule, IsRandomButTheSameEachTime) {
  std::set<std::string> orders;
  for (int index = 0; index < 30; ++index) {
    std::string order;
    for (const Trial& trial : schedule(kClips, index, 1)) order += trial.clip[0];
    orders.insert(order);
    const auto again = schedule(kClips, index, 1);
    EXPECT_EQ(again.back().code, schedule(kClips, index, 1).back().code);
  }
  // 3! orders a part: 36 of them; 30 draws give 20 ± 2 different ones.
  EXPECT_GT(orders.size(), 10u);
  // The engine is given by the C++ standard: the same on every machine.
  EXPECT_EQ(schedule({"x"}, 0, 1)[0].code, schedule({"y"}, 0, 1)[0].code);
  EXPECT_THROW(schedule({}, 0, 1), std::invalid_argument);
  EXPECT_THROW(schedule({"x", "x"}, 0, 1), std::invalid_argument);
}

class StudyFile : public testing::Test {
 protected:
  std::string error_of(const std::string& content) {
    std::ofstream(path) << content;
    try {
      read_answers(path);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder = temporary_.path, path = folder / "answers.csv";
};

TEST_F(StudyFile, IsResumedWhereItEnded) {
  EXPECT_TRUE(read_answers(path).empty()) << "no file yet";
  const std::vector<Trial> trials = schedule(kClips, 0, 1);
  append_answer(path, {"P1", trials[0], "movement", 4, "2020-01-01T00:00:00Z"});
  append_answer(path, {"P1", trials[1], "movement", 2, "2020-01-01T00:01:00Z"});
  const std::vector<Answer> answers = read_answers(path);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[1].trial.code, trials[1].code);
  EXPECT_EQ(answers[1].trial.condition, trials[1].condition);
  EXPECT_EQ(answers[1].step, 2);
  EXPECT_EQ(answers[1].time, "2020-01-01T00:01:00Z");
  EXPECT_TRUE(is_answered(answers, "P1", trials[0], "movement"));
  EXPECT_FALSE(is_answered(answers, "P1", trials[0], "mine"));
  EXPECT_FALSE(is_answered(answers, "P1", trials[2], "movement"));
  EXPECT_FALSE(is_answered(answers, "P2", trials[0], "movement"));
  EXPECT_EQ(index_of(answers, "P1"), 0);
  EXPECT_EQ(index_of(answers, "P2"), 1) << "comes next";
  EXPECT_NO_THROW(check_same_trials(answers, "P1", trials));
  EXPECT_THROW(check_same_trials(answers, "P1", schedule({"z.avi"}, 0, 1)), std::invalid_argument);
  EXPECT_NO_THROW(check_same_trials(answers, "P2", schedule({"z.avi"}, 0, 1)));
}

TEST_F(StudyFile, SaysWhatIsWrongAndWhere) {
  const std::string header =
      "participant,trial,part,condition,code,clip,question,answer,time_utc\n";
  EXPECT_NE(error_of("hello\n").find("answers.csv:1: not a file of answers"), std::string::npos);
  const std::string good = "P1,1,controllers,linear,A2,a.avi,movement,3,now\n";
  EXPECT_EQ(error_of(header + good), "");
  EXPECT_NE(error_of(header + good + "P1,2\n").find("answers.csv:3: 2 columns"), std::string::npos);
  EXPECT_NE(error_of(header + "P1,1,controllers,linear,A2,a.avi,movement,6,now\n")
                .find("\"6\" is no number from 1 to 5"),
            std::string::npos);
  EXPECT_NE(error_of(header + "P1,1,controllers,square,A2,a.avi,movement,1,now\n").find("square"),
            std::string::npos);
  EXPECT_THROW(append_answer(path, {"a,b", Trial(), "q", 1, ""}), std::invalid_argument);
  Trial trial;
  trial.clip = "a.avi";
  EXPECT_THROW(append_answer(folder / "none" / "x.csv", {"P", trial, "q", 1, ""}),
               std::runtime_error);
}

TEST(StudyTerminal, AsksUntilThereIsAnAnswer) {
  std::ostringstream out;
  std::istringstream in("\n6\nvery good\n4\nq\n");
  const Question question{"reality", "How real?"};
  EXPECT_EQ(ask(question, in, out), 4);
  EXPECT_NE(out.str().find("How real?"), std::string::npos);
  EXPECT_NE(out.str().find("5 very good"), std::string::npos);
  EXPECT_EQ(ask(question, in, out), 0) << "q";
  EXPECT_EQ(ask(question, in, out), 0) << "no more input";
  std::istringstream ready("\nq\n");
  EXPECT_TRUE(wait_for_return(ready, out));
  EXPECT_FALSE(wait_for_return(ready, out));
  EXPECT_FALSE(wait_for_return(ready, out));
}

class StudyBriefing : public StudyFile {
 protected:
  bool brief_with(const std::vector<std::string>& answers, double force_N = 1, bool pulls = true) {
    Briefing briefing;
    briefing.record = path;
    briefing.participant = "P1";
    briefing.force_N = force_N;
    if (pulls) {
      briefing.while_taut = [this](const std::function<void()>& run) {
        taut = true;
        run();
        taut = false;
      };
    }
    std::string typed;
    for (const std::string& answer : answers) typed += answer + "\n";
    std::istringstream in(typed);
    out.str("");
    return brief(briefing, in, out);
  }

  std::vector<std::string> right() const {
    std::vector<std::string> answers{"yes"};
    answers.resize(1 + exclusions().size(), "no");
    answers.push_back("yes");  // nothing loose
    return answers;
  }

  std::string record() const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  bool taut = false;
  std::ostringstream out;
};

TEST_F(StudyBriefing, NobodyTakesPartWithoutConsentOrWithAReasonAgainstIt) {
  std::vector<std::string> all = right();
  all.insert(all.end(), {"yes", "yes"});
  EXPECT_TRUE(brief_with(all));
  EXPECT_NE(record().find("P1,consent,yes,20"), std::string::npos);
  EXPECT_NE(record().find("P1,eligible,yes,20"), std::string::npos);
  for (size_t i = 0; i < all.size(); ++i) {
    std::vector<std::string> answers = all;
    answers[i] = all[i] == "yes" ? "no" : "yes";
    EXPECT_FALSE(brief_with(answers)) << i;
    EXPECT_NE(out.str().find("P1 does not take part"), std::string::npos) << i;
    answers.resize(i);
    EXPECT_FALSE(brief_with(answers)) << "the input ends at " << i;
  }
  // The reason itself is not recorded.
  EXPECT_NE(record().find("P1,eligible,no,20"), std::string::npos);
  EXPECT_EQ(record().find("implant"), std::string::npos);
}

TEST_F(StudyBriefing, TheEmergencyStopIsTestedWhileTheStringsAreTaut) {
  std::vector<std::string> all = right();
  EXPECT_FALSE(brief_with(all));
  EXPECT_NE(out.str().find("Press the emergency stop"), std::string::npos);
  EXPECT_FALSE(taut);
  EXPECT_TRUE(brief_with(all, 1, false)) << "a simulated device has none";
  all.push_back("maybe");
  all.insert(all.end(), {"yes", "yes"});
  EXPECT_TRUE(brief_with(all));
  EXPECT_NE(record().find("P1,emergency-stop,yes,20"), std::string::npos);
}

TEST_F(StudyBriefing, MoreThanANewtonMustBeConfirmedInWriting) {
  std::vector<std::string> all = right();
  EXPECT_FALSE(brief_with(all, 3, false));
  for (const char* said : {"yes", "I am responsible for 2 N Ada", "I am responsible for 3 N",
                           "I am responsible for 3 N "}) {
    std::vector<std::string> answers = all;
    answers.push_back(said);
    EXPECT_FALSE(brief_with(answers, 3, false)) << said;
  }
  all.push_back("I am responsible for 3 N Ada");
  EXPECT_FALSE(brief_with(all, std::nan(""), false));
  EXPECT_TRUE(brief_with(all, 3, false));
  EXPECT_NE(record().find("P1,force,I am responsible for 3 N Ada,20"), std::string::npos);
}

TEST(StudyStatistics, AreTheTextbookOnes) {
  // 2 (1 + 10 + 45) / 1024, 2 · 11 / 1024, 2 / 1024.
  EXPECT_NEAR(sign_test(8, 2), 112.0 / 1024, 1e-12);
  EXPECT_NEAR(sign_test(1, 9), 22.0 / 1024, 1e-12);
  EXPECT_NEAR(sign_test(10, 0), 2.0 / 1024, 1e-12);
  EXPECT_EQ(sign_test(5, 5), 1);
  EXPECT_EQ(sign_test(0, 0), 1);
  // No success of 10: 1 − 0.025^(1/10); and its mirror image.
  EXPECT_NEAR(share_interval(0, 10).high, 1 - std::pow(0.025, 0.1), 1e-9);
  EXPECT_EQ(share_interval(0, 10).low, 0);
  EXPECT_NEAR(share_interval(10, 10).low, std::pow(0.025, 0.1), 1e-9);
  EXPECT_EQ(share_interval(10, 10).high, 1);
  // What defines the interval: either tail has 2.5 % at its ends.
  const Interval interval = share_interval(8, 10);
  EXPECT_NEAR(1 - binomial_cdf(7, 10, interval.low), 0.025, 1e-9);
  EXPECT_NEAR(binomial_cdf(8, 10, interval.high), 0.025, 1e-9);
  EXPECT_EQ(share_interval(0, 0).high, 1);
}

Answer answer(int participant, Condition condition, const std::string& question, int step,
              const std::string& clip = "a.avi") {
  Answer a;
  a.participant = "P" + std::to_string(participant);
  a.trial.condition = condition;
  a.trial.part = condition == Condition::kLinear || condition == Condition::kNonlinear
                     ? Part::kControllers
                     : Part::kHaptics;
  a.trial.clip = clip;
  a.question = question;
  a.step = step;
  return a;
}

TEST(StudyAnalysis, GivesTheTablesOfThePaper) {
  // Ten people as in Table 1: linear good for five, nonlinear for eight; and as "reality" of
  // Table 2, 2.4 without and 4.2 with.
  std::vector<Answer> answers;
  const int linear[] = {1, 2, 2, 1, 2, 3, 4, 5, 3, 3};
  const int nonlinear[] = {2, 1, 3, 4, 5, 4, 4, 5, 3, 5};
  const int without[] = {2, 2, 2, 3, 3, 3, 2, 2, 2, 3};
  const int with[] = {4, 4, 4, 4, 4, 4, 4, 4, 5, 5};
  for (int i = 0; i < 10; ++i) {
    answers.push_back(answer(i, Condition::kNonlinear, "movement", nonlinear[i]));
    answers.push_back(answer(i, Condition::kLinear, "movement", linear[i]));
    answers.push_back(answer(i, Condition::kWith, "reality", with[i]));
    answers.push_back(answer(i, Condition::kWithout, "reality", without[i]));
  }
  const std::vector<Rating> r = ratings(answers);
  ASSERT_EQ(r.size(), 4u);
  EXPECT_EQ(r[0].condition, Condition::kLinear) << "the first condition first";
  EXPECT_EQ(r[0].good, 5);
  EXPECT_EQ(r[1].good, 8);
  EXPECT_EQ(r[0].counts[2], 3);
  EXPECT_NEAR(r[2].mean, 2.4, 1e-12);
  EXPECT_NEAR(r[3].mean, 4.2, 1e-12);

  const std::vector<Comparison> c = comparisons(answers);
  ASSERT_EQ(c.size(), 2u);
  // Differences 1 −1 1 3 3 1 0 0 0 2.
  EXPECT_EQ(c[0].higher, 6);
  EXPECT_EQ(c[0].lower, 1);
  EXPECT_EQ(c[0].equal, 3);
  EXPECT_NEAR(c[0].p, 2 * 8.0 / 128, 1e-12);  // 2 (1 + 7) / 2⁷
  EXPECT_EQ(c[1].higher, 10);
  EXPECT_NEAR(c[1].p, 2.0 / 1024, 1e-12);
  EXPECT_NE(report(answers).find("controllers: movement      linear"), std::string::npos)
      << report(answers);
}

TEST(StudyAnalysis, CountsAPersonOnceAndOnlyWhatIsComplete) {
  std::vector<Answer> answers;
  // Three clips, two better and one much worse: worse as a whole, and one vote.
  answers.push_back(answer(1, Condition::kLinear, "movement", 3, "a"));
  answers.push_back(answer(1, Condition::kNonlinear, "movement", 4, "a"));
  answers.push_back(answer(1, Condition::kLinear, "movement", 3, "b"));
  answers.push_back(answer(1, Condition::kNonlinear, "movement", 4, "b"));
  answers.push_back(answer(1, Condition::kLinear, "movement", 5, "c"));
  answers.push_back(answer(1, Condition::kNonlinear, "movement", 1, "c"));
  // Stopped in the middle of a pair.
  answers.push_back(answer(2, Condition::kLinear, "movement", 3, "a"));
  const std::vector<Comparison> c = comparisons(answers);
  ASSERT_EQ(c.size(), 1u);
  EXPECT_EQ(c[0].higher, 0);
  EXPECT_EQ(c[0].lower, 1);
  EXPECT_EQ(c[0].equal, 0);
}

}  // namespace
}  // namespace study
