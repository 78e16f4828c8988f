/// Whose scans are; and what recorded bags are made of.
#include <gtest/gtest.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/Correlation.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/FitWarnings.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/LineForces.h>
#include <tensegric_fit/TriangleMesh.h>

#include "ros/scan_labels.hpp"

namespace tensegric_fit::node {
namespace {

ScanLabel label(const std::string& scan_id, const std::string& source, const std::string& customer) {
  ScanLabel label;
  label.scan_id = scan_id;
  label.source = source;
  label.customer = customer;
  return label;
}

TEST(ScanLabels, LabelsOfOneScanAddUpAndTheLaterHolds) {
  ScanLabels labels;
  labels.add(label("1", "a.ply", ""));
  labels.add(label("2", "b.ply", "0815"));
  labels.add(label("1", "", "4711"));
  EXPECT_EQ(labels.of("1").source, "a.ply");
  EXPECT_EQ(labels.of("1").customer, "4711");
  labels.add(label("1", "", "4712"));
  EXPECT_EQ(labels.of("1").customer, "4712");
  EXPECT_EQ(labels.of("2").customer, "0815");
  EXPECT_EQ(labels.of("3").customer, "");
  EXPECT_EQ(labels.of("3").scan_id, "3");
}

TEST(ScanLabels, WhatIsDroppedIsNotKnownAndTheOthersAre) {
  ScanLabels labels;
  labels.add(label("1", "a.ply", "4711"));
  labels.add(label("2", "b.ply", "0815"));
  labels.drop("1");
  labels.drop("3");
  EXPECT_EQ(labels.of("1").customer, "");
  EXPECT_EQ(labels.of("1").source, "");
  EXPECT_EQ(labels.of("2").customer, "0815");
}

TEST(ScanLabels, OldOnesGo) {
  ScanLabels labels;
  for (std::size_t i = 0; i <= ScanLabels::kKept; ++i) labels.add(label(std::to_string(i), "", "x"));
  EXPECT_EQ(labels.of("0").customer, "");
  EXPECT_EQ(labels.of("1").customer, "x");
}

// Bags of shops hold these. Whoever changes one ships migration rules for rosbag with it (launch/migration),
// and a bag of before (tests/data) that tests/migration_test.py converts; only then may its checksum here be
// another.
TEST(RecordedMessages, AreOfTheVersionsThatBagsHave) {
  using ros::message_traits::md5sum;
  EXPECT_STREQ(md5sum<BodyModel>(), "ffe6925a62eaeae72106ae1f8479e5c3");
  EXPECT_STREQ(md5sum<ControlMesh>(), "399aa9f6ad30decc07646d2624840d14");
  EXPECT_STREQ(md5sum<Correlation>(), "17446fade23a5e6055d6e984000bd2ad");
  EXPECT_STREQ(md5sum<DeformedMesh>(), "cd4d1bb649eb4b71039d05f7f837a126");
  EXPECT_STREQ(md5sum<FitState>(), "cff66f1785a2d0d16624aaa2ff4a2599");
  EXPECT_STREQ(md5sum<FitWarnings>(), "d35687d9c521008144d0f368bcafc697");
  EXPECT_STREQ(md5sum<Garment>(), "f4abe0d29f94e1e68f129f87843bac7e");
  EXPECT_STREQ(md5sum<Landmarks>(), "0a2f63ab35eef53fe823bae2c263e7f2");
  EXPECT_STREQ(md5sum<LineForces>(), "1ca8110e30b0e6a2552035c454ccf799");
  EXPECT_STREQ(md5sum<ScanLabel>(), "e7310851b8882bb2fc171a343ed320e7");
  EXPECT_STREQ(md5sum<TriangleMesh>(), "cd61873fa32d8db0590665e13898a017");
}

}  // namespace
}  // namespace tensegric_fit::node
