// Wisp for C# and for Unity: a thin wrapper of the C ABI (include/wisp/wisp.h), one file to copy into Assets/ beside the
// native library (Assets/Plugins: libwisp.so, wisp.dll, libwisp.dylib). Calls of a frame allocate nothing: the caller
// owns the arrays. An object may be used by one thread at a time.
//
//     var model = Model.Read("flame.wisp");
//     var bank = new Bank(model, capacity: 100);
//     ulong flame = bank.Spawn();
//     bank.SetCommonInputs(inputs);                     // every frame; a float[], as single numbers allocate one
//     bank.Advance(Time.deltaTime);
//     bank.Polyline(flame, points);                     // x, y in turn
using System;
using System.IO;
using System.Runtime.InteropServices;
using System.Text;

namespace Wisp
{
    /// <summary>An error of the library, with its message.</summary>
    public sealed class WispException : Exception
    {
        public readonly int Status;

        public WispException(int status, string message) : base(message)
        {
            Status = status;
        }
    }

    internal static class Native
    {
#if (UNITY_IOS || UNITY_WEBGL) && !UNITY_EDITOR
        internal const string Library = "__Internal";
#else
        internal const string Library = "wisp";
#endif
        private const CallingConvention C = CallingConvention.Cdecl;

        [StructLayout(LayoutKind.Sequential)]
        internal struct ModelFacts
        {
            public uint Size, Inputs, Outputs, ControlPoints, Usable, Reserved;
            public double RateHz, MetresPerUnit;
            public long StepNanoseconds, MultiplyAddsPerFrame, OperationsPerFrame;
            public double BlowOutLevel, BlowOutSeconds;
            public uint Dynamics, View;
            public double HalfWidth, HalfLength, BlowOutHaste, BlowOutRecoverySeconds;
            public uint BlowOutInput, Reserved2;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Channel
        {
            public uint Size, Reserved;
            public IntPtr Name, Unit;
            public double Lowest, Highest;
            public uint EvenOdd, Reserved2;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct BankOptions
        {
            public uint Size, Capacity, PolylinePoints, Longest;
            public ulong Seed;
            public IntPtr Memory;
            public UIntPtr MemorySize;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct BankFacts
        {
            public uint Size, Capacity, Alive, Slots, Inputs, Outputs, PolylinePoints, Reserved;
            public ulong Held, Steps;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct FlameState
        {
            public uint Size, Lit;
            public float FlameSize;
            public uint Events;
            public long SinceLit, SinceOut;
            public float X, Y, Z, Intensity, Kelvin;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct WindOptions
        {
            public uint Size, Channels;
            public double RateHz, FrameRateHz, Exponent, SmoothingSeconds, FloorRiseDbPerSecond, FirstGustRms;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Recipe
        {
            public uint Size, Kind;
            public int Na, Nb, Nk, Modes;
            public IntPtr Event, Name;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Provenance
        {
            public uint Size, Sources, Options, Figures, Usable, Reserved;
            public IntPtr Program, Reason;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct ChainSettings
        {
            public uint Size, HasGround;
            public float Ground;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Place
        {
            public uint Size, Segment, Step, Mode;
            public float VelocityX, VelocityY, VelocityZ, SpinX, SpinY, SpinZ;
            public uint Lies, Landed;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct BodyMoment
        {
            public uint Size;
            public float X, Y, Z, Qw, Qx, Qy, Qz, Vx, Vy, Vz, Wx, Wy, Wz;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Target
        {
            public uint Size;
            public float X, Y, Z;
            public long Nanoseconds;
            public float Within;
            public uint Reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Calibration
        {
            public uint Size;
            public float BackgroundRms, BackgroundLevel, FloorDb, GustRms;
        }

        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_version();
        [DllImport(Library, CallingConvention = C)] internal static extern IntPtr wisp_last_error();
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_load(byte[] bytes, UIntPtr size, out IntPtr model);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_model_free(IntPtr model);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_facts(IntPtr model, ref ModelFacts facts);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_input(IntPtr model, uint index, ref Channel channel);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_output(IntPtr model, uint index, ref Channel channel);
        [DllImport(Library, CallingConvention = C)] internal static extern IntPtr wisp_model_name(IntPtr model);
        [DllImport(Library, CallingConvention = C)] internal static extern BankOptions wisp_bank_default_options();
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_create(IntPtr model, ref BankOptions options, out IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_bank_free(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_facts(IntPtr bank, ref BankFacts facts);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_spawn(IntPtr bank, out ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_spawn_stream(IntPtr bank, ulong stream, out ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_end(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_alive(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_inputs(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_common_inputs(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_instance_inputs(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_noise(IntPtr bank, float scale);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_step(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_advance(IntPtr bank, long nanoseconds, out int steps);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_outputs(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_instance_outputs(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_polylines(IntPtr bank, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_polyline(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_in_the_round(IntPtr model, out IntPtr round);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_look(IntPtr bank, float rightX, float rightZ);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_rings(IntPtr bank, ulong instance, float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_ring_mesh(float[] rings, uint count, uint segments, float[] numbers, UIntPtr room, UIntPtr stride);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_ring_triangles(uint rings, uint segments, uint[] indices, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_flame_state(IntPtr bank, ulong instance, ref FlameState state);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_relight(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_extinguish(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern WindOptions wisp_wind_default_options();
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_create(ref WindOptions options, out IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_wind_free(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_feed(IntPtr wind, float[] samples, UIntPtr count, [Out] WindFrame[] frames, UIntPtr room, out UIntPtr taken, out UIntPtr made);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_provenance(IntPtr model, ref Provenance provenance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_model_get_source(IntPtr model, uint index, out IntPtr name);
        [DllImport(Library, CallingConvention = C)] internal static extern ulong wisp_bank_at(IntPtr bank, uint slot);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_noise(IntPtr bank, out float scale);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_advance_seconds(IntPtr bank, double seconds, out int steps);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_step_many(IntPtr bank, uint steps, float[] inputs, UIntPtr inputCount, [Out] float[] outputs, UIntPtr outputCount);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_flame_sizes(IntPtr bank, [Out] float[] values, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_chain_place(IntPtr bank, ulong instance, ref Place place);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_place(IntPtr bank, ulong instance, ref BodyMoment body);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_steer(IntPtr bank, ulong instance, ref Target target);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_release(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_can_steer(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_set_ground(IntPtr bank, float height);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_clear_ground(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_get_chain_settings(IntPtr bank, ref ChainSettings settings);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_reset_instance(IntPtr bank, ulong instance);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_reset(IntPtr bank);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_save_bytes(IntPtr bank, out UIntPtr bytes);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_save(IntPtr bank, [Out] byte[] bytes, UIntPtr size);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_bank_restore(IntPtr bank, byte[] bytes, UIntPtr size);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_latest(IntPtr wind, out WindFrame frame);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_calibrate(IntPtr wind, uint what, double seconds);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_calibrating(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_calibrated(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern double wisp_wind_room_rise(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_get_calibration(IntPtr wind, ref Calibration calibration);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_set_calibration(IntPtr wind, ref Calibration calibration);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_wind_reset(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern double wisp_wind_latency(IntPtr wind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_set_attribute(IntPtr recording, byte[] name, byte[] value);

        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_create(double rateHz, out IntPtr recording);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_recording_free(IntPtr recording);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_add(IntPtr recording, uint role, byte[] name, byte[] unit, double[] samples, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_recording_set_episodes(IntPtr recording, long[] ids, UIntPtr count);
        [DllImport(Library, CallingConvention = C)] internal static extern Recipe wisp_recipe_default(uint kind);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_learn(IntPtr[] recordings, UIntPtr count, ref Recipe recipe, IntPtr progress, IntPtr of, out IntPtr fit);
        [DllImport(Library, CallingConvention = C)] internal static extern void wisp_fit_free(IntPtr fit);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_fit_get_model(IntPtr fit, out IntPtr bytes, out UIntPtr size);
        [DllImport(Library, CallingConvention = C)] internal static extern int wisp_fit_usable(IntPtr fit);
        [DllImport(Library, CallingConvention = C)] internal static extern IntPtr wisp_fit_reason(IntPtr fit);

        internal static int Version { get { return wisp_version(); } }

        internal static byte[] Utf8(string text)
        {
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        internal static void Check(int status)
        {
            if (status != 0) throw new WispException(status, Text(wisp_last_error()));
        }

        internal static string Text(IntPtr utf8)
        {
            int length = 0;
            while (Marshal.ReadByte(utf8, length) != 0) ++length;
            var bytes = new byte[length];
            Marshal.Copy(utf8, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        internal static UIntPtr Count(Array values)
        {
            return values == null ? UIntPtr.Zero : (UIntPtr)(ulong)values.Length;
        }
    }

    /// <summary>The meaning of a model's outputs.</summary>
    public enum View { Plain = 0, Outline = 1, Pose = 2, Position = 3 }

    /// <summary>The kind of dynamics.</summary>
    public enum Dynamics { Arx = 1, Chain = 2, Switched = 3 }

    /// <summary>Name and range of an input or output.</summary>
    public struct Channel
    {
        public string Name, Unit;
        public double Lowest, Highest;
    }

    /// <summary>A model. Its banks stay valid after it is disposed.</summary>
    public sealed class Model : IDisposable
    {
        internal IntPtr Handle;
        private Native.ModelFacts facts;

        /// <summary>Reads the bytes of a .wisp file (in Unity: a TextAsset's bytes, of NAME.wisp.bytes).</summary>
        public Model(byte[] bytes)
        {
            Native.Check(Native.wisp_model_load(bytes, Native.Count(bytes), out Handle));
            ReadFacts();
        }

        private Model(IntPtr handle)
        {
            Handle = handle;
            ReadFacts();
        }

        private void ReadFacts()
        {
            facts.Size = (uint)Marshal.SizeOf(typeof(Native.ModelFacts));
            Native.Check(Native.wisp_model_get_facts(Handle, ref facts));
        }

        /// <summary>The same flame as a body of revolution: its wind is x, to the right of the camera that filmed it,
        /// and z, towards that camera. A new model, to be disposed of.</summary>
        public Model InTheRound()
        {
            IntPtr round;
            Native.Check(Native.wisp_model_in_the_round(Handle, out round));
            return new Model(round);
        }

        public static Model Read(string path)
        {
            return new Model(File.ReadAllBytes(path));
        }

        public int Inputs { get { return (int)facts.Inputs; } }
        public int Outputs { get { return (int)facts.Outputs; } }
        public int ControlPoints { get { return (int)facts.ControlPoints; } }
        public bool Usable { get { return facts.Usable != 0; } }
        public double RateHz { get { return facts.RateHz; } }
        public View View { get { return (View)facts.View; } }
        public Dynamics Dynamics { get { return (Dynamics)facts.Dynamics; } }
        public string Name { get { return Native.Text(Native.wisp_model_name(Handle)); } }

        /// <summary>Reason of the verdict; program that wrote the file; recordings that the model learned from.</summary>
        public string Reason { get { return Native.Text(Origin().Reason); } }
        public string Program { get { return Native.Text(Origin().Program); } }
        public string[] Sources()
        {
            var names = new string[Origin().Sources];
            for (uint k = 0; k < names.Length; ++k)
            {
                IntPtr name;
                Native.Check(Native.wisp_model_get_source(Handle, k, out name));
                names[k] = Native.Text(name);
            }
            return names;
        }

        private Native.Provenance Origin()
        {
            var origin = new Native.Provenance { Size = (uint)Marshal.SizeOf(typeof(Native.Provenance)) };
            Native.Check(Native.wisp_model_get_provenance(Handle, ref origin));
            return origin;
        }

        public Channel Input(int index)
        {
            Native.Channel channel = Empty();
            Native.Check(Native.wisp_model_get_input(Handle, (uint)index, ref channel));
            return Named(channel);
        }

        public Channel Output(int index)
        {
            Native.Channel channel = Empty();
            Native.Check(Native.wisp_model_get_output(Handle, (uint)index, ref channel));
            return Named(channel);
        }

        private static Native.Channel Empty()
        {
            return new Native.Channel { Size = (uint)Marshal.SizeOf(typeof(Native.Channel)) };
        }

        private static Channel Named(Native.Channel from)
        {
            return new Channel { Name = Native.Text(from.Name), Unit = Native.Text(from.Unit), Lowest = from.Lowest, Highest = from.Highest };
        }

        public void Dispose()
        {
            Native.wisp_model_free(Handle);
            Handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Model() { Native.wisp_model_free(Handle); }
    }

    /// <summary>State of a body: metres, seconds, radians, z up; an all-zero quaternion is level.</summary>
    public struct Body
    {
        public float X, Y, Z, Qw, Qx, Qy, Qz, Vx, Vy, Vz, Wx, Wy, Wz;
    }

    /// <summary>Position of an instance in its chain.</summary>
    public struct ChainPlace
    {
        public int Segment, Step, Mode;
        /// <summary>Over the last step: metres and radians a second, z up.</summary>
        public float VelocityX, VelocityY, VelocityZ, SpinX, SpinY, SpinZ;
        /// <summary>Lies: at rest on the ground. Landed: touched the ground in the last Step or Advance.</summary>
        public bool Lies, Landed;
    }

    /// <summary>A flame as a light: position in the outline's units, intensity relative to rest and colour temperature
    /// (Unity: Light.colorTemperature); and its events in the last Step or Advance.</summary>
    public struct FlameState
    {
        public bool Lit, WentOut, Relit;
        public float X, Y, Z, Intensity, Kelvin;
    }

    /// <summary>Living instances of one model, stepped together. Bulk arrays have a row for each slot.</summary>
    public sealed class Bank : IDisposable
    {
        private IntPtr handle;

        /// <summary>`longest`: maximum seconds advanced by one Advance.</summary>
        public Bank(Model model, int capacity = 1, ulong seed = 1, int polylinePoints = 32, double longest = 10)
        {
            Native.BankOptions options = Native.wisp_bank_default_options();
            options.Capacity = (uint)capacity;
            options.Seed = seed;
            options.PolylinePoints = (uint)polylinePoints;
            options.Longest = (uint)Math.Max(1, Math.Round(longest * 1000));
            Native.Check(Native.wisp_bank_create(model.Handle, ref options, out handle));
            GC.KeepAlive(model);  // its finalizer would free what the call reads
        }

        public int Slots { get { return (int)Facts().Slots; } }
        public int Alive { get { return (int)Facts().Alive; } }
        public int PolylinePoints { get { return (int)Facts().PolylinePoints; } }

        private Native.BankFacts Facts()
        {
            var facts = new Native.BankFacts { Size = (uint)Marshal.SizeOf(typeof(Native.BankFacts)) };
            Native.Check(Native.wisp_bank_get_facts(handle, ref facts));
            return facts;
        }

        /// <summary>Starts an instance. The lower half of its id is its slot.</summary>
        public ulong Spawn()
        {
            ulong instance;
            Native.Check(Native.wisp_bank_spawn(handle, out instance));
            return instance;
        }

        /// <summary>Starts an instance with a given random stream: the same stream and inputs give the same play.</summary>
        public ulong Spawn(ulong stream)
        {
            ulong instance;
            Native.Check(Native.wisp_bank_spawn_stream(handle, stream, out instance));
            return instance;
        }

        public void End(ulong instance) { Native.Check(Native.wisp_bank_end(handle, instance)); }
        public bool IsAlive(ulong instance) { return Native.wisp_bank_alive(handle, instance) != 0; }

        /// <summary>Sets inputs from the next step on: a row per slot, one row for all slots, or one instance's.</summary>
        public void SetInputs(float[] values) { Native.Check(Native.wisp_bank_set_inputs(handle, values, Native.Count(values))); }
        public void SetCommonInputs(params float[] values) { Native.Check(Native.wisp_bank_set_common_inputs(handle, values, Native.Count(values))); }
        public void SetInputs(ulong instance, float[] values) { Native.Check(Native.wisp_bank_set_instance_inputs(handle, instance, values, Native.Count(values))); }

        /// <summary>The instance in a slot; 0 when it is empty.</summary>
        public ulong At(int slot) { return Native.wisp_bank_at(handle, (uint)slot); }

        public float Noise()
        {
            float scale;
            Native.Check(Native.wisp_bank_get_noise(handle, out scale));
            return scale;
        }

        /// <summary>Scale of the noise: 1 as learned, 0 none.</summary>
        public void SetNoise(float scale) { Native.Check(Native.wisp_bank_set_noise(handle, scale)); }

        public void Step() { Native.Check(Native.wisp_bank_step(handle)); }

        /// <summary>Advances by a time such as Time.deltaTime. Returns the number of steps.</summary>
        public int Advance(double seconds)
        {
            int steps;
            Native.Check(Native.wisp_bank_advance_seconds(handle, seconds, out steps));
            return steps;
        }

        /// <summary>Advances by whole nanoseconds, as a replay needs. Returns the number of steps.</summary>
        public int AdvanceNanoseconds(long nanoseconds)
        {
            int steps;
            Native.Check(Native.wisp_bank_advance(handle, nanoseconds, out steps));
            return steps;
        }

        /// <summary>Many steps in one call: inputs (steps x slots x inputs) and outputs (steps x slots x outputs), or null.</summary>
        public void Step(int steps, float[] inputs = null, float[] outputs = null)
        {
            Native.Check(Native.wisp_bank_step_many(handle, (uint)steps, inputs, Native.Count(inputs), outputs, Native.Count(outputs)));
        }

        /// <summary>Writes outputs into an array of slots x outputs, or one instance's.</summary>
        public void Outputs(float[] values) { Native.Check(Native.wisp_bank_outputs(handle, values, Native.Count(values))); }
        public void Outputs(ulong instance, float[] values) { Native.Check(Native.wisp_bank_instance_outputs(handle, instance, values, Native.Count(values))); }

        /// <summary>Writes outlines as x, y, x, y, …: slots x points x 2, or one instance's.</summary>
        public void Polylines(float[] values) { Native.Check(Native.wisp_bank_polylines(handle, values, Native.Count(values))); }
        public void Polyline(ulong instance, float[] values) { Native.Check(Native.wisp_bank_polyline(handle, instance, values, Native.Count(values))); }

        /// <summary>In the round: sets the level camera by its right direction, a unit vector (x, z).</summary>
        public void Look(float rightX, float rightZ) { Native.Check(Native.wisp_bank_look(handle, rightX, rightZ)); }

        /// <summary>In the round: (points + 1) / 2 rings from the base to the tip, six numbers each: x, y, z of the
        /// centre, the radius, and the rise of the rim towards +x and +z.</summary>
        public void Rings(ulong instance, float[] values) { Native.Check(Native.wisp_bank_rings(handle, instance, values, Native.Count(values))); }

        /// <summary>Surface of rings: rings x segments vertices with position and normal, `stride` numbers apart; and
        /// three indices for each of its 2 x rings x segments - 4 triangles, anticlockwise seen from outside. Unity's
        /// triangles are clockwise and its z is reversed: negate z, or swap two indices.</summary>
        public static void Mesh(float[] rings, int segments, float[] numbers, int stride = 6) { Native.Check(Native.wisp_ring_mesh(rings, (uint)(rings.Length / 6), (uint)segments, numbers, Native.Count(numbers), (UIntPtr)stride)); }
        public static void Triangles(int rings, int segments, uint[] indices) { Native.Check(Native.wisp_ring_triangles((uint)rings, (uint)segments, indices, Native.Count(indices))); }

        /// <summary>State of a flame, its light, and its events.</summary>
        public FlameState Flame(ulong instance)
        {
            var state = new Native.FlameState { Size = (uint)Marshal.SizeOf(typeof(Native.FlameState)) };
            Native.Check(Native.wisp_bank_get_flame_state(handle, instance, ref state));
            return new FlameState { Lit = state.Lit != 0, WentOut = (state.Events & 1) != 0, Relit = (state.Events & 2) != 0, X = state.X, Y = state.Y, Z = state.Z, Intensity = state.Intensity, Kelvin = state.Kelvin };
        }

        public bool IsLit(ulong instance) { return Flame(instance).Lit; }

        /// <summary>Writes the flame's size of each slot, 0 to 1; outlines already include it.</summary>
        public void FlameSizes(float[] values) { Native.Check(Native.wisp_bank_flame_sizes(handle, values, Native.Count(values))); }

        public void Relight(ulong instance) { Native.Check(Native.wisp_bank_relight(handle, instance)); }
        public void Extinguish(ulong instance) { Native.Check(Native.wisp_bank_extinguish(handle, instance)); }

        /// <summary>Leaves: continues from a body's state, as after a throw. Wisp's z is up, metres, seconds.</summary>
        public void Place(ulong instance, Body body)
        {
            var moment = new Native.BodyMoment
            {
                Size = (uint)Marshal.SizeOf(typeof(Native.BodyMoment)), X = body.X, Y = body.Y, Z = body.Z, Qw = body.Qw, Qx = body.Qx, Qy = body.Qy, Qz = body.Qz,
                Vx = body.Vx, Vy = body.Vy, Vz = body.Vz, Wx = body.Wx, Wy = body.Wy, Wz = body.Wz
            };
            if (body.Qw == 0 && body.Qx == 0 && body.Qy == 0 && body.Qz == 0) moment.Qw = 1;
            Native.Check(Native.wisp_bank_place(handle, instance, ref moment));
        }

        /// <summary>The segment that an instance plays, the step in it, and its mode.</summary>
        public ChainPlace PlaceInChain(ulong instance)
        {
            var place = new Native.Place { Size = (uint)Marshal.SizeOf(typeof(Native.Place)) };
            Native.Check(Native.wisp_bank_get_chain_place(handle, instance, ref place));
            return new ChainPlace
            {
                Segment = (int)place.Segment, Step = (int)place.Step, Mode = (int)place.Mode,
                VelocityX = place.VelocityX, VelocityY = place.VelocityY, VelocityZ = place.VelocityZ,
                SpinX = place.SpinX, SpinY = place.SpinY, SpinZ = place.SpinZ,
                Lies = place.Lies != 0, Landed = place.Landed != 0
            };
        }

        /// <summary>Steers an instance to a place (metres) to be reached in `seconds`; Release ends this.</summary>
        public void Steer(ulong instance, float x, float y, float z, double seconds, float within = 0.1f)
        {
            var target = new Native.Target { Size = (uint)Marshal.SizeOf(typeof(Native.Target)), X = x, Y = y, Z = z, Nanoseconds = (long)(seconds * 1e9), Within = within };
            Native.Check(Native.wisp_bank_steer(handle, instance, ref target));
        }

        public void Release(ulong instance) { Native.Check(Native.wisp_bank_release(handle, instance)); }
        public bool CanSteer { get { return Native.wisp_bank_can_steer(handle) != 0; } }

        /// <summary>Height of level ground, metres; null: leaves fall for ever.</summary>
        public float? Ground
        {
            get { var settings = Settings(); return settings.HasGround != 0 ? settings.Ground : (float?)null; }
            set { Native.Check(value.HasValue ? Native.wisp_bank_set_ground(handle, value.Value) : Native.wisp_bank_clear_ground(handle)); }
        }

        private Native.ChainSettings Settings()
        {
            var settings = new Native.ChainSettings { Size = (uint)Marshal.SizeOf(typeof(Native.ChainSettings)) };
            Native.Check(Native.wisp_bank_get_chain_settings(handle, ref settings));
            return settings;
        }

        /// <summary>Resets to the state at spawning: all instances and the bank's time, or one.</summary>
        public void Reset() { Native.Check(Native.wisp_bank_reset(handle)); }
        public void Reset(ulong instance) { Native.Check(Native.wisp_bank_reset_instance(handle, instance)); }

        /// <summary>The whole state; restoring it in a bank of this model and capacity gives the same bits.</summary>
        public byte[] Save()
        {
            UIntPtr size;
            Native.Check(Native.wisp_bank_save_bytes(handle, out size));
            var bytes = new byte[(int)size];
            Native.Check(Native.wisp_bank_save(handle, bytes, size));
            return bytes;
        }

        public void Restore(byte[] bytes) { Native.Check(Native.wisp_bank_restore(handle, bytes, Native.Count(bytes))); }

        public void Dispose()
        {
            Native.wisp_bank_free(handle);
            handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Bank() { Native.wisp_bank_free(handle); }
    }

    /// <summary>The wind during one frame of sound: wisp_wind_frame.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct WindFrame
    {
        public long Index;
        public float Rms, RmsClean, Level, Speed, Wind, Confidence, Background, Clipped;
    }

    /// <summary>Converts a microphone's samples (OnAudioFilterRead, Microphone) to wind, a model's input.</summary>
    public sealed class WindLevel : IDisposable
    {
        private readonly WindFrame[] frames = new WindFrame[64];
        private IntPtr handle;

        public WindLevel(double rateHz, int channels = 1, double frameRateHz = 60)
        {
            Native.WindOptions options = Native.wisp_wind_default_options();
            options.RateHz = rateHz;
            options.Channels = (uint)channels;
            options.FrameRateHz = frameRateHz;
            Native.Check(Native.wisp_wind_create(ref options, out handle));
        }

        /// <summary>The latest frame; all zero before the first.</summary>
        public WindFrame Latest
        {
            get
            {
                WindFrame frame;
                Native.Check(Native.wisp_wind_latest(handle, out frame));
                return frame;
            }
        }

        /// <summary>Calibrates by the coming seconds of sound, taken as gentle breath or as hard blowing.</summary>
        public void Calibrate(bool blowHard, double seconds = 3) { Native.Check(Native.wisp_wind_calibrate(handle, blowHard ? 1u : 0u, seconds)); }
        public bool Calibrating { get { return Native.wisp_wind_calibrating(handle) != 0; } }
        public bool Calibrated { get { return Native.wisp_wind_calibrated(handle) != 0; } }

        /// <summary>Rise of the room's level, dB; from 6 on something steady may be mistaken for wind.</summary>
        public double RoomRise { get { return Native.wisp_wind_room_rise(handle); } }
        public double Latency { get { return Native.wisp_wind_latency(handle); } }
        public void Reset() { Native.Check(Native.wisp_wind_reset(handle)); }

        /// <summary>Calibration of a microphone, to store: background RMS and level, floor in dB, gust RMS.</summary>
        public float[] Calibration
        {
            get
            {
                var kept = new Native.Calibration { Size = (uint)Marshal.SizeOf(typeof(Native.Calibration)) };
                Native.Check(Native.wisp_wind_get_calibration(handle, ref kept));
                return new[] { kept.BackgroundRms, kept.BackgroundLevel, kept.FloorDb, kept.GustRms };
            }
            set
            {
                var kept = new Native.Calibration { Size = (uint)Marshal.SizeOf(typeof(Native.Calibration)), BackgroundRms = value[0], BackgroundLevel = value[1], FloorDb = value[2], GustRms = value[3] };
                Native.Check(Native.wisp_wind_set_calibration(handle, ref kept));
            }
        }

        /// <summary>Takes interleaved samples, full scale +-1. Returns the number of completed frames.</summary>
        public int Feed(float[] samples)
        {
            UIntPtr taken, made;
            int all = 0;
            float[] block = samples;
            while (true)
            {
                Native.Check(Native.wisp_wind_feed(handle, block, Native.Count(block), frames, Native.Count(frames), out taken, out made));
                int count = (int)made, used = (int)taken;
                all += count;
                if (used == block.Length) return all;
                var rest = new float[block.Length - used];  // only for more than 64 frames in one block
                Array.Copy(block, used, rest, 0, rest.Length);
                block = rest;
            }
        }

        public void Dispose()
        {
            Native.wisp_wind_free(handle);
            handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~WindLevel() { Native.wisp_wind_free(handle); }
    }

    /// <summary>The role of a channel.</summary>
    public enum Role { Input = 0, Output = 1, Motion = 2 }

    /// <summary>Kind of model to learn, as in wisp.h.</summary>
    public enum Recipe { Arx = 1, Outline = 2, Flame = 3, Chain = 4, Leaf = 5, Flicker = 6 }

    /// <summary>A recording: channels of one rate and length. NaN is a missing sample.</summary>
    public sealed class Recording : IDisposable
    {
        internal IntPtr Handle;

        public Recording(double rateHz) { Native.Check(Native.wisp_recording_create(rateHz, out Handle)); }

        public void Add(Role role, string name, double[] samples, string unit = "")
        {
            Native.Check(Native.wisp_recording_add(Handle, (uint)role, Native.Utf8(name), Native.Utf8(unit), samples, Native.Count(samples)));
        }

        /// <summary>Sets a fact about the whole recording ("knots", "pair", …).</summary>
        public void SetAttribute(string name, string value) { Native.Check(Native.wisp_recording_set_attribute(Handle, Native.Utf8(name), Native.Utf8(value))); }

        /// <summary>Sets the episode of each row; no history crosses from one episode to the next.</summary>
        public void SetEpisodes(long[] ids) { Native.Check(Native.wisp_recording_set_episodes(Handle, ids, Native.Count(ids))); }

        public void Dispose()
        {
            Native.wisp_recording_free(Handle);
            Handle = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Recording() { Native.wisp_recording_free(Handle); }
    }

    /// <summary>A fit: the bytes of a model's file, and its verdict. Learning takes seconds: run it in an editor or on its own
    /// thread. A library built without learning throws EntryPointNotFoundException.</summary>
    public sealed class Fit
    {
        public readonly byte[] Bytes;
        public readonly bool Usable;
        public readonly string Reason;

        /// <summary>na, nb and nk (-1: estimated) apply to Recipe.Arx; the defaults are the library's.</summary>
        public Fit(Recipe recipe, Recording[] recordings, int? na = null, int? nb = null, int? nk = null)
        {
            Native.Recipe chosen = Native.wisp_recipe_default((uint)recipe);
            chosen.Na = na ?? chosen.Na;
            chosen.Nb = nb ?? chosen.Nb;
            chosen.Nk = nk ?? chosen.Nk;
            IntPtr fit, bytes;
            UIntPtr size;
            IntPtr[] handles = Array.ConvertAll(recordings, recording => recording.Handle);
            Native.Check(Native.wisp_learn(handles, Native.Count(handles), ref chosen, IntPtr.Zero, IntPtr.Zero, out fit));
            GC.KeepAlive(recordings);
            try
            {
                Native.Check(Native.wisp_fit_get_model(fit, out bytes, out size));
                Bytes = new byte[(int)size];
                Marshal.Copy(bytes, Bytes, 0, Bytes.Length);
                Usable = Native.wisp_fit_usable(fit) != 0;
                Reason = Native.Text(Native.wisp_fit_reason(fit));
            }
            finally
            {
                Native.wisp_fit_free(fit);
            }
        }
    }
}
