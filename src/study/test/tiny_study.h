#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/scratch_folder.h"
#include "simulation/test/small_models.h"
#include "study/simulated_study.h"
#include "study/trial_pair.h"

namespace hvas::study::testing {

/** A study of a peg in a block: three timed conditions once, and two fits blind twice each. */
inline constexpr const char* kTinyProtocol = R"(
format: hvas-study-1
id: tiny
title: Tiny
product: peg
part: peg
participants: 2
languages: [en, de]
mating_window_s: 1
consent: You may stop at any time.
defaults: {time_limit_s: 60, fit: H7/g6}
conditions:
  - {id: free, name: Contact, method: constraint_only, published_mean_s: 12.6}
  - {id: guided, name: Both, method: hybrid, published_mean_s: 9.4}
  - {id: mouse, name: Mouse, method: constraints_by_picking}
  - {id: loose, name: Loose, method: hybrid, fit: H7/g6}
  - {id: tight, name: Tight, method: hybrid, fit: H7/p6, published_right_share: 0.8}
training: {minutes: 1, condition: guided}
blocks:
  - {id: timed, conditions: [free, guided, mouse], order: latin_square}
  - {id: blind, conditions: [loose, tight], identification: true, repetitions: 2, question: Which}
questions:
  - {id: calm, kind: scale, text: How calm, low: 1, high: 10}
  - {id: easy, kind: scale, text: How easy, low: 1, high: 10}
  - id: hand
    kind: choice
    asked: after_block
    block: timed
    text: Which hand did you use?
    choices:
      - {id: left, text: The left one}
      - {id: right, text: The right one}
  - {id: remarks, kind: text, text: Anything else, longest: 10}
)";

inline Protocol MakeTinyProtocol() {
  auto protocol = ParseProtocol(kTinyProtocol, "tiny.yaml");
  EXPECT_TRUE(protocol) << protocol.error().ToString();
  return *protocol;
}

/** The model of a peg in a block with the fit of a condition; compiled once for each key. */
inline Result<std::shared_ptr<const simulation::Model>> PegModel(
    const Condition& condition, const std::string& /*part*/ = "peg") {
  static std::map<std::string, std::shared_ptr<const simulation::Model>> known;
  auto& model = known[MakeFitKey(condition, "peg")];
  if (model == nullptr) {
    auto product = std::make_shared<product::Product>(simulation::testing::PegInBlock());
    if (const auto applied = ApplyFit(condition, "peg", product.get()); !applied) {
      return Unexpected(applied.error());
    }
    Diagnostics diagnostics;
    model = *simulation::Compile(product, simulation::testing::FastOptions(), &diagnostics);
  }
  return model;
}

inline std::string ReadAll(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/** Reads all files below a folder. @returns their bytes by relative path. */
inline std::map<std::string, std::string> ReadFolder(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[std::filesystem::relative(entry.path(), folder).string()] = ReadAll(entry.path());
    }
  }
  return files;
}

}  // namespace hvas::study::testing
