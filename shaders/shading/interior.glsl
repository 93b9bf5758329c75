// What a ray is inside of, where clear bodies overlap: there the medium of the highest rank is alone, the others are not.
//
// A medium's rank is 1 to 255, 0 stands for none (the outside). A list holds four ranks, one a byte, the highest first.
// Source: Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images".
#ifndef SHADING_INTERIOR_GLSL
#define SHADING_INTERIOR_GLSL


// The highest rank of a list, 0 if it is empty.
uint interior_top(uint list) {
    return list >> 24u;
}

// The list of a ray that has entered a medium of rank `rank` (1 to 255). Of five the lowest is forgotten.
uint interior_add(uint list, uint rank) {
    if (rank > (list >> 24u)) {
        return (rank << 24u) | (list >> 8u);
    }
    if (rank > ((list >> 16u) & 255u)) {
        return (list & 0xff000000u) | (rank << 16u) | ((list >> 8u) & 0xffffu);
    }
    if (rank > ((list >> 8u) & 255u)) {
        return (list & 0xffff0000u) | (rank << 8u) | ((list >> 8u) & 255u);
    }
    return rank > (list & 255u) ? (list & 0xffffff00u) | rank : list;
}

// The list of a ray that has left a medium of rank `rank` (1 to 255) once; the list itself if it was not inside.
uint interior_remove(uint list, uint rank) {
    if (rank == (list >> 24u)) {
        return list << 8u;
    }
    if (rank == ((list >> 16u) & 255u)) {
        return (list & 0xff000000u) | ((list & 0xffffu) << 8u);
    }
    if (rank == ((list >> 8u) & 255u)) {
        return (list & 0xffff0000u) | ((list & 255u) << 8u);
    }
    return rank == (list & 255u) ? list & 0xffffff00u : list;
}

// The list of a ray that an interface to a medium of rank `rank` (0: no medium) has let in (`entering`) or out.
uint cross_interface(uint list, uint rank, bool entering) {
    if (rank == 0u) {
        return list;
    }
    return entering ? interior_add(list, rank) : interior_remove(list, rank);
}

#endif
