/* SPDX-License-Identifier: MIT */
/* Keys and mouse from a file; see script.h. */
#include "script.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const Uint32 from_script = UINT32_MAX; /* not the number of any window */

static int SDLCALL only_from_script(void *unused, SDL_Event *e)
{
    (void)unused;
    switch (e->type) {
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        return e->key.windowID == from_script;
    case SDL_MOUSEMOTION:
        return e->motion.windowID == from_script;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        return e->button.windowID == from_script;
    default:
        return 1;
    }
}

bool script_open(script *s, const char *path)
{
    *s = (script){.file = fopen(path, "r"), .path = path, .frame_time = 1.0 / 60};
    if (s->file == NULL)
        fprintf(stderr, "springs: %s: %s\n", path, strerror(errno));
    else
        SDL_SetEventFilter(only_from_script, NULL);
    return s->file != NULL;
}

void script_close(script *s)
{
    if (s->file != NULL)
        fclose(s->file);
    s->file = NULL;
}

/* Pushes the same events as SDL for a real key. They are so few that the queue cannot be full. */
static bool push_key(const char *name)
{
    const SDL_Keycode key = SDL_GetKeyFromName(name);
    SDL_Event e = {.key = {.type = SDL_KEYDOWN, .windowID = from_script, .state = SDL_PRESSED, .keysym = {.sym = key}}};
    if (key == SDLK_UNKNOWN)
        return false;
    SDL_PushEvent(&e);
    e.key.type = SDL_KEYUP;
    e.key.state = SDL_RELEASED;
    SDL_PushEvent(&e);
    return true;
}

static bool push_move(script *s, const char *words)
{
    int x, y;
    if (sscanf(words, "%d %d", &x, &y) != 2)
        return false;
    SDL_Event e = {.motion = {.type = SDL_MOUSEMOTION, .windowID = from_script, .state = s->held}};
    e.motion.x = x;
    e.motion.y = y;
    e.motion.xrel = x - s->x;
    e.motion.yrel = y - s->y;
    s->x = x;
    s->y = y;
    SDL_PushEvent(&e);
    return true;
}

static bool push_button(script *s, const char *name, bool down)
{
    static const char *const names[] = {"left", "middle", "right"};
    for (Uint8 i = 0; i < 3; i++)
        if (strcmp(name, names[i]) == 0) {
            const Uint8 button = (Uint8)(i + 1); /* SDL_BUTTON_LEFT, _MIDDLE, _RIGHT */
            SDL_Event e = {.button = {.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                      .windowID = from_script,
                                      .button = button,
                                      .state = down ? SDL_PRESSED : SDL_RELEASED,
                                      .clicks = 1,
                                      .x = s->x,
                                      .y = s->y}};
            const Uint32 mask = SDL_BUTTON(button);
            s->held = down ? s->held | mask : s->held & ~mask;
            SDL_PushEvent(&e);
            return true;
        }
    return false;
}

static bool save(SDL_Renderer *renderer, const char *path)
{
    int width, height;
    if (SDL_GetRendererOutputSize(renderer, &width, &height) != 0)
        return false;
    SDL_Surface *picture = SDL_CreateRGBSurfaceWithFormat(0, width, height, 24, SDL_PIXELFORMAT_BGR24);
    const bool saved =
        picture != NULL &&
        SDL_RenderReadPixels(renderer, NULL, SDL_PIXELFORMAT_BGR24, picture->pixels, picture->pitch) == 0 &&
        SDL_SaveBMP(picture, path) == 0;
    SDL_FreeSurface(picture);
    return saved;
}

static bool play_line(script *s, SDL_Renderer *renderer, const char *state, const char *verb, const char *words)
{
    if (strcmp(verb, "wait") == 0)
        return (s->wait = atoi(words)) > 0;
    if (strcmp(verb, "frame") == 0)
        return (s->frame_time = atof(words)) > 0;
    if (strcmp(verb, "key") == 0)
        return push_key(words);
    if (strcmp(verb, "move") == 0)
        return push_move(s, words);
    if (strcmp(verb, "press") == 0)
        return push_button(s, words, true);
    if (strcmp(verb, "release") == 0)
        return push_button(s, words, false);
    if (strcmp(verb, "save") == 0)
        return save(renderer, words);
    if (strcmp(verb, "say") == 0)
        return puts(state) >= 0 && fflush(stdout) == 0;
    return false;
}

bool script_play(script *s, SDL_Renderer *renderer, const char *state)
{
    char line[512], verb[16], words[480];
    while (s->wait == 0) {
        if (fgets(line, sizeof line, s->file) == NULL)
            return false;
        s->line++;
        words[0] = '\0';
        const int found = sscanf(line, "%15s %479[^\n]", verb, words);
        if (found < 1 || verb[0] == '#')
            continue;
        if (!play_line(s, renderer, state, verb, words)) {
            fprintf(stderr, "springs: %s:%d: cannot %s %s\n", s->path, s->line, verb, words);
            s->failed = true;
            return false;
        }
    }
    s->wait--;
    return true;
}
