#include "lidar_panoptic_clustering/simulation/ground.h"
#include "lidar_panoptic_clustering/simulation/labels.h"
#include "lidar_panoptic_clustering/simulation/models.h"
#include "lidar_panoptic_clustering/simulation/street.h"

#include <algorithm>

namespace lidar_panoptic_clustering::simulation
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
constexpr std::uint32_t kThingsPerBlock = 64;
constexpr std::int64_t kBlocksUntilIdsRepeat = kLastStaticInstance / kThingsPerBlock;

constexpr double kParkingLine = 6.1;     // middle of parked cars, offset from the centre line [m]
constexpr double kFurnitureLine = 7.65;  // lamps, signs, street trees

constexpr double kEmptyPlace = 5.0;    // of the parking strip [m]
constexpr double kTwoWheelers = 0.92;  // kinds from here on are rows of bicycles or motorcycles

struct ParkedKind
{
  Footprint (*add)(std::vector<Solid>&, const Pose&, std::uint32_t, std::uint32_t, Random);
  std::uint32_t label;
};

/// What stands in a place, by a number in [0, kTwoWheelers); long vehicles only where there is room.
ParkedKind parkedKind(double kind, double room)
{
  if (kind < 0.86 || room < 13.5) return {addCar, label::kCar};
  if (kind < 0.885) return {addTruck, label::kTruck};
  if (kind < 0.895) return {addBus, label::kBus};
  return {addTrailer, label::kOtherVehicle};
}

/// One side of one block. Each kind of thing draws from a stream of its own, so that a density moves nothing else.
class BlockSide
{
public:
  BlockSide(const StreetConfig& config, const Course& course, std::int64_t index, double side, std::uint32_t& things,
            std::vector<Solid>& solids)
      : config_(config),
        course_(course),
        start_(static_cast<double>(index) * kBlockLengthM),
        side_(side),
        key_(hash(hash(config.seed, static_cast<std::uint64_t>(index)), side > 0.0 ? 1 : 2)),
        first_instance_(static_cast<std::uint32_t>(((index % kBlocksUntilIdsRepeat) + kBlocksUntilIdsRepeat) %
                                                   kBlocksUntilIdsRepeat) *
                            kThingsPerBlock +
                        1),
        things_(things),
        solids_(solids)
  {
  }

  void build()
  {
    addParkingStrip();
    addFurniture();
    addIdlers();
    addYards();
  }

private:
  /// `along` metres into the block, `out` metres from the centre line; turned so that y points away from the street.
  Pose at(double along, double out, double z, double turn = 0.0) const
  {
    return course_.at(start_ + along, side_ * out, z, (side_ > 0.0 ? 0.0 : kPi) + turn);
  }
  Random stream(std::uint64_t number) const { return Random(hash(key_, number)); }
  std::uint32_t nextInstance() { return first_instance_ + std::min(things_++, kThingsPerBlock - 1); }
  bool full() const { return things_ + 4 > kThingsPerBlock; }

  void addParkingStrip();
  double addParkedVehicle(const ParkedKind& kind, double along, double aside, double turn, Random look);
  void addParkedRow(double along, Random& random, bool motorcycles);
  void addFurniture();
  void addIdlers();
  void addYards();
  void addHouse(double begin, double end, double setback, Random& random);
  void addGarden(double begin, double end, Random& random);
  void addBoundary(double begin, double end, Random& random);

  const StreetConfig& config_;
  const Course& course_;
  double start_, side_;
  std::uint64_t key_;
  std::uint32_t first_instance_;
  std::uint32_t& things_;  // of the whole block
  std::vector<Solid>& solids_;
};

void BlockSide::addParkingStrip()
{
  Random random = stream(1);
  double along = random.uniform(0.3, 1.5);
  while (along < kBlockLengthM - 5.2 && !full())
  {
    const bool taken = random.chance(config_.parking_density);
    const double kind = random.uniform(0.0, 1.0), close = random.uniform(0.4, 1.0), wide = random.uniform(1.0, 3.0);
    const double gap = random.chance(0.55) ? close : wide;
    const double jitter = random.uniform(-0.03, 0.03), turn = jitter + (random.chance(0.3) ? kPi : 0.0);
    const double aside = kParkingLine + random.uniform(-0.1, 0.1);
    const Random look(random.next());

    double length = kEmptyPlace;
    if (taken && kind >= kTwoWheelers)
      addParkedRow(along, random, random.chance(0.5));
    else if (taken)
      length = addParkedVehicle(parkedKind(kind, kBlockLengthM - along), along, aside, turn, look);
    along += length + gap;
  }
}

double BlockSide::addParkedVehicle(const ParkedKind& kind, double along, double aside, double turn, Random look)
{
  const std::uint32_t instance = nextInstance();
  // how long a model is shows once it is built: built aside first, then into the row
  std::vector<Solid> aside_built;
  const double length = kind.add(aside_built, {}, kind.label, instance, look).length;
  kind.add(solids_, at(along + 0.5 * length, aside, 0.0, turn), kind.label, instance, look);
  return length;
}

void BlockSide::addParkedRow(double along, Random& random, bool motorcycles)
{
  for (double place = along + 0.6; place < along + 4.4; place += motorcycles ? 1.25 : 0.9)
  {
    const double turn = 0.5 * kPi + random.uniform(-0.15, 0.15);
    const bool taken = random.chance(0.8);
    if (!taken || full()) continue;
    if (motorcycles)
      addMotorcycle(solids_, at(place, 6.0, 0.0, turn), label::kMotorcycle, nextInstance());
    else
      addBicycle(solids_, at(place, 6.0, 0.0, turn), label::kBicycle, nextInstance());
  }
}

void BlockSide::addFurniture()
{
  Random random = stream(2);
  const double lamp = random.uniform(4.0, 8.0);
  addLamp(solids_, at(lamp, kFurnitureLine, kCurbHeight));
  addLamp(solids_, at(lamp + 25.0, kFurnitureLine, kCurbHeight));
  for (int i = 0; i < 2; ++i)
  {
    const double along = random.uniform(1.0, 24.0) + 25.0 * i;
    const bool present = random.chance(0.7);
    if (present)
      addTrafficSign(solids_, at(along, kFurnitureLine, kCurbHeight, side_ > 0.0 ? kPi : 0.0), Random(random.next()));
  }
  for (double along = 1.5; along < kBlockLengthM; along += 9.5)
  {
    const double shift = random.uniform(-0.8, 0.8);
    const bool present = random.chance(0.6);
    const std::uint64_t look = random.next();
    if (present) addTree(solids_, at(along + shift, kFurnitureLine + 0.1, kCurbHeight), Random(look));
  }
}

void BlockSide::addIdlers()
{
  Random random = stream(3);
  for (double along = 4.0; along < kBlockLengthM; along += 11.0)
  {
    const double shift = random.uniform(-2.5, 2.5), kind = random.uniform(0.0, 1.0);
    const bool present = random.chance(config_.pedestrian_density);
    const int count = 1 + random.below(3);
    const std::uint64_t look = random.next();
    if (!present || full()) continue;
    if (kind < 0.2)
      addBicycle(solids_, at(along + shift, 10.25, kCurbHeight, 0.05), label::kBicycle, nextInstance());
    else if (kind < 0.28)
      addBicyclist(solids_, at(along + shift, 7.95, kCurbHeight, 0.3), label::kBicyclist, nextInstance(), Random(look));
    else
      for (int i = 0; i < count; ++i)
        addPerson(solids_, at(along + shift + 0.75 * i, 10.15 + 0.2 * (i % 2), kCurbHeight, 3.0 * i), label::kPerson,
                  nextInstance(), 0.0F, Random(hash(look, static_cast<std::uint64_t>(i))));
  }
}

void BlockSide::addYards()
{
  Random random = stream(4);
  double begin = random.uniform(0.0, 2.0);
  double setback = random.uniform(0.3, 6.0);
  while (kBlockLengthM - begin > 7.0)
  {
    const double wanted = random.uniform(9.0, 16.0), kind = random.uniform(0.0, 1.0);
    const double gap = random.chance(0.5) ? 0.0 : random.uniform(2.5, 7.0);
    if (random.chance(0.5)) setback = random.uniform(0.3, 7.0);
    const double end = std::min(begin + wanted, kBlockLengthM);
    if (kind < 0.8)
      addHouse(begin, end, setback, random);
    else
      addGarden(begin, end, random);
    if (gap > 0.0) addBoundary(end, std::min(end + gap, kBlockLengthM), random);
    begin = end + gap;
  }
  if (kBlockLengthM - begin > 1.0) addBoundary(begin, kBlockLengthM, random);
}

void BlockSide::addHouse(double begin, double end, double setback, Random& random)
{
  const double height = random.uniform(6.5, 15.0);
  const std::uint64_t look = random.next();
  const double middle = 0.5 * (begin + end), length = end - begin;
  addBuilding(solids_, at(middle, kSidewalkEdge + setback, kCurbHeight), static_cast<float>(length),
              static_cast<float>(height), Random(look));
  if (setback < 2.5) return;
  addBoundary(begin, end, random);
  const double bush = random.uniform(begin + 1.0, end - 1.0);
  addBush(solids_, at(bush, kSidewalkEdge + setback - 1.2, kCurbHeight), Random(random.next()));
}

void BlockSide::addGarden(double begin, double end, Random& random)
{
  for (int i = 0; i < 5; ++i)
  {
    const double along = random.uniform(begin + 1.0, end - 1.0), out = kSidewalkEdge + random.uniform(3.0, 22.0);
    const bool tree = random.chance(0.6);
    const std::uint64_t look = random.next();
    if (tree)
      addTree(solids_, at(along, out, kCurbHeight), Random(look));
    else
      addBush(solids_, at(along, out, kCurbHeight), Random(look));
  }
  addFence(solids_, at(0.5 * (begin + end), 36.0, kCurbHeight), static_cast<float>(end - begin), Random(random.next()));
  addBoundary(begin, end, random);
}

void BlockSide::addBoundary(double begin, double end, Random& random)
{
  const double kind = random.uniform(0.0, 1.0), height = random.uniform(0.9, 1.9);
  const auto length = static_cast<float>(end - begin);
  const std::uint64_t look = random.next();
  if (length < 0.5F) return;
  const Pose pose = at(0.5 * (begin + end), kSidewalkEdge + 0.4, kCurbHeight);
  if (kind < 0.45)
    addFence(solids_, pose, length, Random(look));
  else if (kind < 0.85)
    addHedge(solids_, pose, length, static_cast<float>(height));
}
}  // namespace

std::vector<Solid> buildBlock(const StreetConfig& config, const Course& course, std::int64_t index)
{
  std::vector<Solid> solids;
  std::uint32_t things = 0;
  for (const double side : {-1.0, 1.0}) BlockSide(config, course, index, side, things, solids).build();
  return solids;
}
}  // namespace lidar_panoptic_clustering::simulation
