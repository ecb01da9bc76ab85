// Registers what a world of rigid bodies uses. Jolt's own list also names its vehicles, ragdolls and hair,
// and so would pull all of them into the library.

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Physics/Collision/CollisionDispatch.h>
#include <Jolt/Physics/Collision/PhysicsMaterialSimple.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/CylinderShape.h>
#include <Jolt/Physics/Collision/Shape/EmptyShape.h>
#include <Jolt/Physics/Collision/Shape/HeightFieldShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/MutableCompoundShape.h>
#include <Jolt/Physics/Collision/Shape/OffsetCenterOfMassShape.h>
#include <Jolt/Physics/Collision/Shape/PlaneShape.h>
#include <Jolt/Physics/Collision/Shape/RotatedTranslatedShape.h>
#include <Jolt/Physics/Collision/Shape/ScaledShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/Shape/StaticCompoundShape.h>
#include <Jolt/Physics/Collision/Shape/TaperedCapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/TaperedCylinderShape.h>
#include <Jolt/Physics/Collision/Shape/TriangleShape.h>
#include <Jolt/RegisterTypes.h>

#include <cstdlib>

JPH_NAMESPACE_BEGIN

bool VerifyJoltVersionIDInternal(uint64 client_version) {
    return client_version == JPH_VERSION_ID;
}

void RegisterTypesInternal(uint64 client_version) {
    // A client compiled with other JPH_ definitions would see other layouts.
    if (!VerifyJoltVersionIDInternal(client_version))
        std::abort();

    CollisionDispatch::sInit();

    // Compounds come before what they hold and decorators come last: a later entry replaces an earlier one.
    CompoundShape::sRegister();
    ConvexShape::sRegister();
    MutableCompoundShape::sRegister();
    StaticCompoundShape::sRegister();

    TriangleShape::sRegister();
    PlaneShape::sRegister();
    SphereShape::sRegister();
    BoxShape::sRegister();
    CapsuleShape::sRegister();
    TaperedCapsuleShape::sRegister();
    CylinderShape::sRegister();
    TaperedCylinderShape::sRegister();
    MeshShape::sRegister();
    ConvexHullShape::sRegister();
    HeightFieldShape::sRegister();

    RotatedTranslatedShape::sRegister();
    OffsetCenterOfMassShape::sRegister();
    ScaledShape::sRegister();
    EmptyShape::sRegister();

    if (PhysicsMaterial::sDefault == nullptr)
        PhysicsMaterial::sDefault = new PhysicsMaterialSimple("Default", Color::sGrey);
}

void UnregisterTypes() {
    if (Factory::sInstance != nullptr)
        Factory::sInstance->Clear();
    PhysicsMaterial::sDefault = nullptr;
}

JPH_NAMESPACE_END
