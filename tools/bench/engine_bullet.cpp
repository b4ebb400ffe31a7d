// SPDX-License-Identifier: MIT
// A sheet as a soft body of Bullet, in its own world without collisions. Bullet's links have no stiffness in N/m. The
// position solver moves both ends of each link to its length, in one iteration per step, which is the work of one force
// per link. The links are in random order, as in Bullet's own examples. In grid order, each link depends on the result
// of the previous one, which takes longer, and stiff sheets explode.
#include "engine.h"

#include <btBulletDynamicsCommon.h>

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <cstdio>

namespace
{

const char *version()
{
    static char text[16];
    std::snprintf(text, sizeof text, "%d.%02d", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100);
    return text;
}

struct World {
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btSoftBody *body;
};

const btScalar share_of_velocity = btScalar(0.01); // removed by damping

btVector3 vector(const double *v)
{
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

void *make(const spring_scene_def *def)
{
    World *world = new World;
    btSoftBodyWorldInfo &info = world->world.getWorldInfo();
    info.m_dispatcher = &world->dispatcher;
    info.m_broadphase = &world->broadphase;
    info.m_gravity = vector(def->gravity);
    info.m_sparsesdf.Initialize();
    btAlignedObjectArray<btVector3> places;
    for (size_t i = 0; i < def->particles; i++)
        places.push_back(vector(&def->position[3 * i]));
    btSoftBody *body = new btSoftBody(&info, int(def->particles), &places[0], nullptr);
    for (size_t i = 0; i < def->particles; i++)
        body->setMass(int(i), def->pinned[i] != 0 ? btScalar(0) : btScalar(def->mass_all));
    for (size_t i = 0; i < def->links; i++)
        body->appendLink(int(def->link[i].a), int(def->link[i].b));
    body->randomizeConstraints();
    body->setSolver(btSoftBody::eSolverPresets::Positions);
    body->m_cfg.piterations = 1;
    body->m_cfg.kDP = share_of_velocity;
    body->m_cfg.collisions = 0;
    body->setActivationState(DISABLE_DEACTIVATION); // otherwise it stops when at rest
    world->world.addSoftBody(body);
    world->body = body;
    return world;
}

void step(void *world, double dt)
{
    static_cast<World *>(world)->world.stepSimulation(btScalar(dt), 0);
}

void position(const void *world, size_t particle, double *x)
{
    const btVector3 &at = static_cast<const World *>(world)->body->m_nodes[int(particle)].m_x;
    for (int a = 0; a < 3; a++)
        x[a] = double(at[a]);
}

} // namespace

const physics_engine engine_bullet = {
    "bullet", sizeof(btScalar) == sizeof(float) ? "float" : "double", version, 3, make, step, position,
};
